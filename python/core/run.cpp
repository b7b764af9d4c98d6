#include "python/core/run.h"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include "engine/core/error.h"
#include "engine/core/whole_file.h"
#include "engine/imaging/png.h"
#include "engine/playback/run_frames.h"
#include "engine/render/scene.h"
#include "engine/run/run.h"
#include "python/core/arguments.h"
#include "python/core/scenario.h"
#include "python/core/usage_error.h"
#include "python/core/yaml_from_python.h"
#include "tools/replay/replay_run.h"
#include "tools/report/report.h"
#include "tools/report/run_files.h"

namespace vinerow::python {
namespace py = pybind11;
namespace {

/// Whether Ctrl-C was pressed, or another signal handler of Python raised an exception, which then
/// is pending. Called without the interpreter's lock.
class Interrupt {
 public:
  bool seen() {
    if (seen_) return true;
    const py::gil_scoped_acquire acquire;
    seen_ = PyErr_CheckSignals() != 0;
    if (seen_) error_.emplace();  // takes the pending exception
    return seen_;
  }
  /// @throws the exception of Python, if there was one. Called with the interpreter's lock.
  void raise() {
    if (!seen_) return;
    py::error_already_set error = std::move(*error_);
    error_.reset();
    throw error;
  }

 private:
  bool seen_ = false;
  std::optional<py::error_already_set> error_;
};

/// Thrown to leave the writing of a report.
struct Interrupted {};

std::vector<std::string> run_files(const LoadedScenario& loaded, const PathArgument& folder,
                                   bool log, bool pictures, bool report) {
  const std::filesystem::path out = folder.value("out");
  std::vector<std::string> missing;
  Interrupt interrupt;
  run::RunOptions options;
  options.out = out;
  options.log = log;
  options.pictures = pictures;
  options.interrupted = [&interrupt] { return interrupt.seen(); };
  {
    const py::gil_scoped_release release;
    const run::RunResult result = run::run_scenario(loaded.scenario, *loaded.registry, options);
    for (const std::string& sentence : {result.picture_note, result.write_failure}) {
      if (!sentence.empty()) missing.push_back(sentence);
    }
    tools::FurtherFiles further;
    further.out = out;
    further.coverage_and_maps = log && pictures && loaded.scenario.record.enabled;
    further.report = report;
    further.missing = [&missing](const std::string& sentence, bool) {
      missing.push_back(sentence);
    };
    further.report_progress = [&interrupt](int, int) {
      if (interrupt.seen()) throw Interrupted();
    };
    try {
      if (!interrupt.seen()) {
        tools::write_further_files(loaded.scenario, *loaded.registry, result, further);
      }
    } catch (const Interrupted&) {
    }
  }
  interrupt.raise();
  return missing;
}

/// The built-in parts, and those of the plug-ins that a run's scenario names.
std::shared_ptr<const Registry> registry_of_run(const std::filesystem::path& folder) {
  const std::filesystem::path scenario = folder / "scenario.resolved.yaml";
  if (!std::filesystem::is_regular_file(scenario)) return registry_with({});
  return registry_with(scenario::load_plugin_list(scenario));
}

void write_report(const PathArgument& path) {
  const std::filesystem::path folder = path.value("folder");
  const py::gil_scoped_release release;
  tools::write_report(folder, *registry_of_run(folder), folder / "report.html");
}

void write_replay(const PathArgument& path) {
  const std::filesystem::path folder = path.value("folder");
  const py::gil_scoped_release release;
  if (!tools::has_replay()) throw UsageError("no replay: " + tools::replay_absence());
  const std::shared_ptr<const Registry> registry = registry_of_run(folder);
  write_whole_file(folder / "replay.html",
                   tools::replay_page(tools::read_replay_run(folder, *registry).input()));
}

py::array_t<std::uint8_t> read_picture(const PathArgument& file) {
  const Result<imaging::Pixels> read = imaging::read_png(file.value("file").string());
  if (!read) throw ConfigError(read.reason());
  const py::ssize_t height = read->height, width = read->width;
  py::array_t<std::uint8_t> picture({height, width, py::ssize_t{3}});
  const std::uint8_t* from = read->rgba.data();
  std::uint8_t* to = picture.mutable_data();
  for (py::ssize_t pixel = 0; pixel < height * width; ++pixel, from += 4) {
    to = std::copy(from, from + 3, to);
  }
  return picture;
}

py::bytes encode_picture(
    const py::array_t<std::uint8_t, py::array::c_style | py::array::forcecast>& picture) {
  if (picture.ndim() != 3 || picture.shape(2) != 3 || picture.size() == 0) {
    throw ConfigError("picture must have the shape (h, w, 3)");
  }
  imaging::Pixels pixels(static_cast<int>(picture.shape(1)), static_cast<int>(picture.shape(0)));
  const std::uint8_t* from = picture.data();
  for (std::size_t at = 0; at < pixels.rgba.size(); at += 4, from += 3) {
    std::copy(from, from + 3, &pixels.rgba[at]);
    pixels.rgba[at + 3] = 255;
  }
  return imaging::encode_png(pixels);
}

/// Makes the wish for a camera part of the options.
void choose_camera(const py::object& camera, const std::filesystem::path& log,
                   playback::PictureOptions& options) {
  if (py::isinstance<py::str>(camera)) {
    options.cameras = {camera.cast<std::string>()};
  } else if (py::isinstance<py::dict>(camera)) {
    options.cameras = {"view"};
    options.overrides.values.push_back(
        {"pictures.cameras.view", yaml_from_python(camera, "camera")});
  } else if (camera.is_none()) {
    const auto cameras =
        playback::scenario_of_log(log, *registry_of_run(log.parent_path())).pictures.cameras;
    options.cameras = {cameras.empty() ? "chase" : cameras.front().name};
  } else {
    throw ConfigError(
        fmt::format("camera must be the name of a camera or a dict of its keys, not {}",
                    std::string(py::str(py::type::of(camera).attr("__name__")))));
  }
}

}  // namespace

void check_side(const char* name, std::optional<int> pixels) {
  constexpr int kLeast = 16, kMost = 8192;
  if (!pixels || (*pixels >= kLeast && *pixels <= kMost)) return;
  throw ConfigError(
      fmt::format("{} = {}, must be from {} to {} pixels", name, *pixels, kLeast, kMost));
}

py::array_t<std::uint8_t> pixels_of(const render::Image& image) {
  return py::array_t<std::uint8_t>(std::vector<py::ssize_t>{image.height, image.width, 3},
                                   image.rgb.data());
}

std::vector<py::array_t<std::uint8_t>> render(const std::filesystem::path& log,
                                              const std::vector<double>& times_s,
                                              const py::object& camera, std::optional<int> width,
                                              std::optional<int> height) {
  check_side("width", width);
  check_side("height", height);
  playback::PictureOptions options;
  choose_camera(camera, log, options);
  options.times_s = times_s;
  options.width = width;
  options.height = height;
  std::vector<render::Image> images;
  options.take_frame = [&images](const render::Image& image) { images.push_back(image); };
  Interrupt interrupt;
  options.interrupted = [&interrupt] { return interrupt.seen(); };
  playback::PictureReport report;
  {
    const py::gil_scoped_release release;
    report = playback::render_log(log, {}, *registry_of_run(log.parent_path()), options);
  }
  interrupt.raise();
  if (!report.note.empty()) throw UsageError("no picture: " + report.note);
  if (images.size() != times_s.size()) {
    throw ConfigError(fmt::format("camera '{}' has a picture at {} of the {} times",
                                  options.cameras.front(), images.size(), times_s.size()));
  }
  std::vector<py::array_t<std::uint8_t>> pictures;
  for (const render::Image& image : images) pictures.push_back(pixels_of(image));
  return pictures;
}

void bind_run(py::module_& module) {
  module.def("run_files", &run_files, py::arg("scenario"), py::arg("out"), py::arg("log"),
             py::arg("pictures"), py::arg("report"),
             "Runs a scenario and writes its files into a folder, as `vinerow run` does.\n\n"
             "Returns sentences about files that could not be made.");
  module.def("write_report", &write_report, py::arg("folder"),
             "Writes report.html into the folder of a run.");
  module.def("write_replay", &write_replay, py::arg("folder"),
             "Writes replay.html into the folder of a run.");
  module.def("read_picture", &read_picture, py::arg("file"), "Pixels of a PNG, (h, w, 3).");
  module.def("encode_picture", &encode_picture, py::arg("picture"), "A PNG of (h, w, 3) pixels.");
}

}  // namespace vinerow::python
