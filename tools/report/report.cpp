#include "tools/report/report.h"
#include "engine/playback/frame_words.h"

#include <fmt/format.h>

#include <cmath>
#include <functional>

#include "engine/core/whole_file.h"
#include "tools/replay/replay.h"
#include "tools/replay/replay_run.h"
#include "tools/report/action_plots.h"
#include "tools/report/canopy_strips.h"
#include "tools/report/estimate_plots.h"
#include "tools/report/events.h"
#include "tools/report/fleet.h"
#include "tools/report/html.h"
#include "tools/report/mission_map.h"
#include "tools/report/motion_plots.h"
#include "tools/report/page_pictures.h"
#include "tools/report/page_style.h"
#include "tools/report/papers.h"
#include "tools/report/run_facts.h"
#include "tools/report/run_folder.h"
#include "tools/report/setup.h"
#include "tools/report/time_line.h"
#include "tools/report/units.h"
#include "tools/report/verdict.h"

namespace vinerow::tools {
namespace report {
namespace {

struct Chapter {
  std::string id;
  std::string title;
  std::string content;
};

/// Data from which the chapters are made.
struct PageMaterial {
  std::function<void()> step = [] {};  ///< called before each long step
  RunFolder run;
  std::vector<VehicleLog> vehicles;
  std::vector<Track> tracks;
  std::vector<CanopyFile> canopies;
  std::vector<RunEvent> events;
  std::vector<Picture> frames, coverage, products;
  int picture_width = 1280;
};

/// Number of calls of PageMaterial::step for a page.
int steps_for(std::size_t vehicles) {
  return 6 + static_cast<int>(vehicles);
}

PageMaterial read_material(const std::filesystem::path& folder, const Registry& registry,
                           RunShelf* shelf,
                           const std::function<void(int done, int total)>& progress) {
  PageMaterial m;
  m.run = read_run_folder(folder, registry, shelf);
  if (progress) {
    m.step = [&progress, done = 0, total = steps_for(m.run.vehicles.size())]() mutable {
      progress(done++, total);
    };
  }
  m.step();
  m.vehicles = read_vehicles(m.run);
  for (const VehicleLog& vehicle : m.vehicles) m.tracks.push_back(make_track(vehicle));
  m.canopies = read_canopies(m.run);
  m.events = read_events(m.run);
  m.frames = frame_pictures(m.run);
  m.coverage = coverage_pictures(m.run);
  m.products = product_pictures(m.run);
  m.step();
  std::vector<Picture> all = m.frames;
  for (const auto* more : {&m.coverage, &m.products})
    all.insert(all.end(), more->begin(), more->end());
  m.picture_width = fitting_width(all, kPictureBudget_bytes);
  return m;
}

std::string hero(const PageMaterial& m) {
  const Picture* picture = hero_picture(m.run, m.vehicles, m.frames);
  const auto whole = whole_view(m.run, m.vehicles);
  const auto parcel = parcel_view(m.run, m.vehicles);
  std::string out;
  if (picture != nullptr) {
    out +=
        fmt::format("<figure class=\"opens\">{}<figcaption>{}</figcaption></figure>\n",
                    embedded(*picture, m.picture_width), escaped(sentence_case(picture->caption)));
  }
  MapStyle style;
  style.with_axes = false;
  style.with_plans = m.vehicles.empty();
  const bool alone = picture == nullptr && !parcel;
  style.width = alone ? 1200 : 640;
  style.min_height = alone ? 300 : 414;
  style.max_height = alone ? 400 : 414;
  const auto add = [&](const std::optional<MapView>& view, const std::string& label) {
    if (!view) return;
    style.label = label;
    out += fmt::format("<figure>{}<figcaption>{}</figcaption></figure>\n",
                       mission_map(m.run, m.vehicles, *view, style),
                       map_legend(m.run, m.vehicles, style));
  };
  if (picture == nullptr || !parcel) add(whole, "the mission from above");
  add(parcel, "the rows from above");
  if (out.empty()) return "";
  return fmt::format("<div class=\"hero{}\">\n{}</div>\n", alone || !whole ? "" : " both", out);
}

/// Time line of the phases, or of the vehicles' activities in a run without phases.
std::string time_lines(const PageMaterial& m) {
  const std::vector<TimeRow> phases = phase_rows(m.run);
  if (!phases.empty()) {
    return time_line(phases, m.run.end_s(), "phases of the mission");
  }
  const std::vector<TimeRow> rows = activity_rows(m.vehicles, m.tracks);
  if (rows.empty()) return "";
  return time_line(rows, m.run.end_s(), "activities of the vehicles over time") +
         activity_legend(rows);
}

std::string first_screen(const PageMaterial& m) {
  m.step();
  const std::string description = m.run.scenario ? m.run.scenario->description : "";
  std::string out =
      fmt::format("<h1>{}</h1>\n<p class=\"lead\">{}</p>\n",
                  escaped(playback::title_of_name(m.run.text("scenario"))), escaped(description));
  Verdict verdict = make_verdict(m.run);
  verdict.remark = canopy_remark(m.run, m.canopies, m.vehicles);
  return out + verdict_box(verdict) + event_notice(m.events) + key_numbers(m.run, m.vehicles) +
         hero(m) + time_lines(m) + setup_table(m.run);
}

std::string map_chapter(const PageMaterial& m) {
  m.step();
  const auto whole = whole_view(m.run, m.vehicles);
  if (!whole) return "";
  MapStyle style;
  style.max_height = 480;
  const auto map = [&](const MapView& view, const std::string& label, const std::string& caption) {
    style.label = label;
    return figure(
        "plot map wide-chart", "",
        map_legend(m.run, m.vehicles, style) + mission_map(m.run, m.vehicles, view, style),
        with_citations(caption));
  };
  std::string out =
      map(*whole, "map of the mission: rows, plans and tracks, north up",
          "True tracks over the planned paths, to scale, north up. As paper A, figures 9, "
          "18 a and 20 a.");
  if (const auto parcel = parcel_view(m.run, m.vehicles)) {
    out += map(*parcel, "map of the parcel: rows, plans and tracks, north up",
               "The same, enlarged to the rows.");
  }
  return out;
}

std::vector<std::string> path_figures(const PageMaterial& m, const VehicleLog& vehicle,
                                      const Track& track) {
  const std::vector<VehicleLog> alone = {vehicle};
  std::vector<std::string> out;
  MapStyle style;
  style.width = 640;
  style.min_height = style.max_height = 330;
  const auto add = [&](const std::optional<MapView>& view, const std::string& title,
                       const std::string& caption) {
    if (!view) return;
    style.label = title;
    out.push_back(figure("plot", title,
                         map_legend(m.run, alone, style) + mission_map(m.run, alone, *view, style),
                         with_citations(caption)));
  };
  if (m.vehicles.size() > 1) {
    add(own_view(vehicle), "Plan and track",
        "Planned path (dashed) and true track (line). As paper A, figures 18 a and 20 a.");
  }
  if (!vehicle.has_wings) {
    style.with_ends = false;
    add(first_turn_view(track), "The first turn",
        "Planned path (dashed) and true track (line), enlarged. As paper A, figures 18 b and 20 "
        "c.");
  }
  return out;
}

/// The first figures, and a fold that opens the others: a page of three vehicles has sixty.
std::string figure_grid(const std::vector<std::string>& figures) {
  constexpr std::size_t kOpen = 4;
  if (figures.empty()) return "<p>This vehicle never started its work.</p>\n";
  std::string first, more;
  for (std::size_t i = 0; i < figures.size(); ++i) (i < kOpen ? first : more) += figures[i];
  std::string out = "<div class=\"figures\">\n" + first + "</div>\n";
  if (more.empty()) return out;
  return out + fmt::format(
                   "<details class=\"more\"><summary>{}</summary>\n<div "
                   "class=\"figures\">\n{}</div></details>\n",
                   counted(static_cast<long>(figures.size() - kOpen), "more plot"), more);
}

std::string plots_chapter(const PageMaterial& m) {
  if (!m.run.log) {
    return "<p>The run wrote no log, so there are no plots. <code>vinerow run</code> without "
           "<code>--no-log</code> writes one.</p>\n";
  }
  std::string out;
  const LinePlot separation = separation_plot(m.vehicles, m.tracks);
  PlotFrame wide;
  wide.width = 1200;
  out += figure(separation, wide);
  for (std::size_t i = 0; i < m.vehicles.size(); ++i) {
    m.step();
    const VehicleLog& vehicle = m.vehicles[i];
    std::vector<std::string> figures = path_figures(m, vehicle, m.tracks[i]);
    for (auto make :
         {motion_plots(m.run, vehicle, m.tracks[i]), estimate_plots(vehicle, m.run.world.get()),
          action_plots(vehicle, m.tracks[i])}) {
      for (const LinePlot& plot : make) figures.push_back(figure(plot));
    }
    std::erase(figures, "");
    out += fmt::format("<h3>{}</h3>\n{}", escaped(vehicle.name), figure_grid(figures));
  }
  return out;
}

std::string pictures_chapter(const PageMaterial& m) {
  m.step();
  const Picture* hero = hero_picture(m.run, m.vehicles, m.frames);
  std::string out;
  for (const auto* pictures : {&m.coverage, &m.products, &m.frames}) {
    for (const Picture& picture : *pictures) {
      // The hero picture is on the first screen.
      if (&picture != hero) out += picture_figure(picture, m.picture_width);
    }
  }
  if (out.empty()) return "";
  out = "<p class=\"hint\">Click a picture to enlarge it.</p>\n<div class=\"gallery\">\n" + out +
        "</div>\n";
  if (m.frames.size() < m.run.frames.size()) {
    out += fmt::format("<p>Showing {} of {} frames; all are in the folder frames of the run.</p>\n",
                       m.frames.size(), m.run.frames.size());
  }
  return out;
}

/// Replay of the run in 3D.
std::string replay_chapter(const PageMaterial& m) {
  const RunFolder& run = m.run;
  m.step();
  if (!run.log || !run.world) return "";
  const playback::LogTrace trace = playback::read_trace(*run.log, run.vehicles);
  ReplayInput input{&*run.scenario, run.world.get(), &run.models, &trace, {}};
  input.phases = phases_of_summary(run.summary.dump(), run.path / "summary.json", trace.last.s());
  return replay_section(input);
}

std::string page(const PageMaterial& m) {
  const std::string first = first_screen(m);
  std::vector<Chapter> chapters = {
      {"replay", "Replay", replay_chapter(m)},
      {"verdicts", "Verdicts", criteria_table(m.run) + metrics_table(m.run)},
      {"events", "Events", event_table(m.events)},
      {"phases", "Phases", phase_table(m.run)},
      {"map", "Map", map_chapter(m)},
      {"canopy", "Canopy", canopy_section(m.run, m.canopies, m.vehicles)},
      {"pictures", "Pictures", pictures_chapter(m)},
      {"plots", "Plots", plots_chapter(m)},
      {"parameters", "Parameters and versions", facts(m.run)},
      {"timings", "Timings", timings(m.run)}};
  std::string content, links;
  for (const Chapter& chapter : chapters) {
    content += section(chapter.id, chapter.title, chapter.content);
  }
  const Chapter sources = {"sources", "Sources", source_list(content)};
  content += section(sources.id, sources.title, sources.content);
  chapters.push_back(sources);
  for (const Chapter& chapter : chapters) {
    if (chapter.content.empty()) continue;
    links += fmt::format("<a href=\"#{}\">{}</a>\n", chapter.id, chapter.title);
  }
  const std::string title = playback::title_of_name(m.run.text("scenario"));
  return page_head(title + ": report of the run", page_style()) + "<nav><div>\n" + links +
         "</div></nav>\n<main>\n" + first + content + "</main>\n" + picture_dialog() +
         "<script>//<![CDATA[" + page_script() + "//]]></script>\n</body>\n</html>\n";
}

}  // namespace
}  // namespace report

void write_report(const std::filesystem::path& run_folder, const Registry& registry,
                  const std::filesystem::path& out_file,
                  const std::function<void(int done, int total)>& progress, RunShelf* shelf) {
  const report::PageMaterial material =
      report::read_material(run_folder, registry, shelf, progress);
  const std::string page = report::page(material);
  write_whole_file(out_file, page);
  if (progress) progress(1, 1);
}

}  // namespace vinerow::tools
