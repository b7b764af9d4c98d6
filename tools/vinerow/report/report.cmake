# The report of a run: one page with verdicts, map, plots and pictures (report.h), for the command and for tests.
set(report_sources
  vinerow/report/action_plots.cpp vinerow/report/axis.cpp vinerow/report/canopy_strips.cpp vinerow/report/decimate.cpp
  vinerow/report/estimate_plots.cpp vinerow/report/events.cpp
  vinerow/report/fleet.cpp vinerow/report/html.cpp vinerow/report/jpeg.cpp
  vinerow/report/line_plot.cpp
  vinerow/report/map_captions.cpp vinerow/report/metric_table.cpp vinerow/report/mission_map.cpp vinerow/report/motion_plots.cpp
  vinerow/report/page_style.cpp vinerow/report/papers.cpp
  vinerow/report/pictures.cpp vinerow/report/report.cpp vinerow/report/row_faces.cpp
  vinerow/report/run_facts.cpp
  vinerow/report/run_folder.cpp vinerow/report/setup.cpp vinerow/report/svg.cpp
  vinerow/report/time_line.cpp vinerow/report/track.cpp
  vinerow/report/units.cpp vinerow/report/vehicle_log.cpp vinerow/report/verdict.cpp vinerow/colour_scale.cpp
  vinerow/report/plot_files.cpp vinerow/export/utf8.cpp)
add_library(vinerow_report STATIC ${report_sources})
vinerow_use_common_headers(vinerow_report)
vinerow_compile_together(vinerow_report 12 ${report_sources})
target_link_libraries(vinerow_report PUBLIC vinerow vinerow_replay nlohmann_json::nlohmann_json PRIVATE fmt::fmt)
