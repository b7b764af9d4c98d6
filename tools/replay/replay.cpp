#include "tools/replay/replay.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "engine/core/check.h"
#include "tools/replay/page_text.h"
#include "tools/replay/replay_assets.h"
#include "tools/replay/replay_index.h"
#include "tools/replay/replay_scene.h"
#include "tools/replay/replay_textures.h"
#include "tools/replay/replay_tracks.h"

namespace vinerow::tools {
namespace {

using nlohmann::json;

/// JSON for a script element: no text in it ends the element or looks like a comment.
std::string script_json(const json& value) {
  std::string out;
  for (const char c : value.dump(-1, ' ', false, json::error_handler_t::replace)) {
    out += c == '<' ? "\\u003c" : std::string(1, c);
  }
  return out;
}

json phases_of(const ReplayInput& input) {
  json phases = json::array();
  for (const ReplayPhase& phase : input.phases) {
    phases.push_back({{"name", phase.name},
                      {"begin", phase.begin_s - input.trace->first.nearest_s()},
                      {"end", phase.end_s - input.trace->first.nearest_s()},
                      {"state", phase.state}});
  }
  return phases;
}

void append_data(std::string& html, const char* id, const char* type, const std::string& text) {
  html += fmt::format("<script type=\"{}\" id=\"vinerow-replay-{}\">", type, id);
  html += text;
  html += "</script>\n";
}

void append_script(std::string& html, std::string_view text) {
  VINEROW_DEMAND(text.find("</script") == std::string_view::npos);
  html += "<script>\n";
  html += text;
  html += "</script>\n";
}

}  // namespace

bool has_replay() {
  return !three_scripts().empty();
}

std::string replay_absence() {
  return has_replay()
             ? ""
             : "this program was built without three.js (Debian: libjs-three), which draws "
               "the replay";
}

std::string replay_section(const ReplayInput& input, const ReplayLimits& limits) {
  VINEROW_DEMAND(input.scenario != nullptr && input.world != nullptr && input.vehicles != nullptr &&
                 input.trace != nullptr);
  VINEROW_DEMAND(input.vehicles->size() == input.scenario->vehicles.size());
  if (!has_replay()) {
    return fmt::format("<p class=\"vinerow-replay-absent\">No replay: {}.</p>\n",
                       escaped(replay_absence()));
  }
  ReplayScene scene = make_replay_scene(input, limits);
  ReplayTracks tracks = make_replay_tracks(input, limits);
  const ReplayTextures textures = make_replay_textures(input.world->daylight);

  json index = replay_index(input.scenario->name, *input.world, textures);
  index["first_s"] = input.trace->first.nearest_s();
  index["duration_s"] = (input.trace->last - input.trace->first).nearest_s();
  index["phases"] = phases_of(input);
  index["vehicles"] = std::move(tracks.index["vehicles"]);
  index["notes"] = json::array();
  for (const std::vector<std::string>* notes : {&scene.notes, &tracks.notes}) {
    for (const std::string& note : *notes) index["notes"].push_back(note);
  }

  std::string html = "<style>\n";
  html += replay_style();
  html += "</style>\n";
  html += replay_markup();
  append_data(html, "index", "application/json", script_json(index));
  append_data(html, "scene", "text/plain", base64(scene.glb));
  append_data(html, "tracks", "text/plain", base64(tracks.bytes));
  append_data(html, "textures", "text/plain", base64(textures.bytes));
  html += "<!--\n";
  html += three_notice();
  html += "-->\n";
  for (const std::vector<EmbeddedFile>& scripts :
       {three_scripts(), picture_scripts(), player_scripts()}) {
    for (const EmbeddedFile& script : scripts) append_script(html, script.text);
  }
  return html;
}

std::string replay_page(const ReplayInput& input, const ReplayLimits& limits) {
  constexpr const char* kStyle =
      "html, body { margin: 0; height: 100%; background: #10151a; }\n"
      ".vinerow-replay { height: 100vh !important; border-radius: 0 !important; }";
  return page_head(input.scenario->name + ": replay", kStyle) + replay_section(input, limits) +
         "</body>\n</html>\n";
}

}  // namespace vinerow::tools
