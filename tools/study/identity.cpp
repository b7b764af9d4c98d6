#include "tools/study/identity.h"

#include <dlfcn.h>

#include <algorithm>
#include <array>
#include <regex>

#include "engine/core/files.h"
#include "engine/core/hash.h"
#include "engine/run/run.h"
#include "engine/run/summary.h"

namespace vinerow::study {
namespace {

namespace fs = std::filesystem;

/// Whether a file may name other files in its text.
bool names_files(const fs::path& file, std::size_t bytes) {
  constexpr std::size_t kLongest = 8 << 20;
  constexpr std::array kExtensions = {".yaml", ".yml", ".sdf",  ".world", ".urdf", ".xacro",
                                      ".dae",  ".obj", ".gltf", ".mtl",   ".vrt",  ".json"};
  const std::string extension = lower_extension(file);
  return bytes < kLongest &&
         std::find(kExtensions.begin(), kExtensions.end(), extension) != kExtensions.end();
}

/// Parts of a text that look like file names.
std::vector<std::string> names_in(const std::string& text) {
  static const std::regex pattern(R"([\w./~+-]+\.[A-Za-z0-9]{1,8}\b)");
  std::vector<std::string> names;
  for (std::sregex_iterator at(text.begin(), text.end(), pattern), end; at != end; ++at) {
    names.push_back(at->str());
  }
  std::sort(names.begin(), names.end());
  names.erase(std::unique(names.begin(), names.end()), names.end());
  return names;
}

/// Collects every scalar of a tree.
void add_scalars(const io::YamlNode& node, std::vector<const io::YamlNode*>& scalars) {
  if (node.is_scalar()) scalars.push_back(&node);
  for (const io::YamlNode& item : node.items) add_scalars(item, scalars);
  for (const io::YamlEntry& entry : node.entries) add_scalars(entry.value, scalars);
}

bool may_be_path(const std::string& text) {
  constexpr std::size_t kLongest = 1000;
  return !text.empty() && text.size() < kLongest && text.find('\n') == std::string::npos &&
         text != "." && text != "..";
}

std::string digest_of_values(const std::vector<scenario::OverrideValue>& values,
                             FileDigests& files) {
  Hasher hasher;
  for (const scenario::OverrideValue& value : values) {
    hasher.add(value.path);
    hasher.add(io::to_yaml(value.value));
    hasher.add(files.of(value.value));
  }
  return hasher.hex();
}

}  // namespace

std::string FileDigests::of(const fs::path& path) {
  const fs::path absolute = path.lexically_normal();
  const auto [place, is_new] = known_.emplace(absolute, "");
  // The file is already known or being read further up: a cycle adds nothing.
  if (!is_new) return place->second;
  Hasher hasher;
  std::error_code error;
  if (fs::is_directory(absolute, error)) {
    std::vector<fs::path> inside;
    for (fs::recursive_directory_iterator at(absolute, error), end; !error && at != end;
         at.increment(error)) {
      if (at->is_regular_file()) inside.push_back(at->path());
    }
    std::sort(inside.begin(), inside.end());
    for (const fs::path& file : inside) {
      hasher.add(file.lexically_relative(absolute).string());
      hasher.add(of(file));
    }
  } else {
    const std::string bytes = read_bytes(absolute).value_or("");
    hasher.add(bytes);
    if (names_files(absolute, bytes.size())) {
      for (const std::string& name : names_in(bytes)) {
        const fs::path named = absolute.parent_path() / name;
        if (!fs::is_regular_file(named, error)) continue;
        hasher.add(name);
        hasher.add(of(named));
      }
    }
  }
  return known_[absolute] = hasher.hex();
}

std::string FileDigests::of(const io::YamlNode& tree) {
  std::vector<const io::YamlNode*> scalars;
  add_scalars(tree, scalars);
  Hasher hasher;
  bool any = false;
  for (const io::YamlNode* scalar : scalars) {
    std::error_code error;
    if (!may_be_path(scalar->text)) continue;
    const fs::path path = (scalar->folder / scalar->text).lexically_normal();
    if (!fs::exists(path, error)) continue;
    hasher.add(scalar->text);
    hasher.add(of(path));
    any = true;
  }
  return any ? hasher.hex() : "";
}

std::string program_digest() {
  Hasher hasher;
  hasher.add(run::program_version());
  hasher.add(read_bytes("/proc/self/exe").value_or(""));
  Dl_info library{};
  if (dladdr(reinterpret_cast<const void*>(&run::run_scenario), &library) != 0) {
    hasher.add(read_bytes(library.dli_fname).value_or(""));
  }
  return hasher.hex();
}

Identity::Identity(const Design& design, const scenario::ScenarioSource& source,
                   const std::string& program)
    : design_(design), program_(program) {
  const scenario::Study& study = design.study();
  FileDigests files;
  Hasher scenario;
  scenario.add(io::to_yaml(source.tree()));
  scenario.add(files.of(source.tree()));
  scenario_ = scenario.hex();
  Hasher common;
  common.add(program);
  common.add(scenario_);
  common.add(digest_of_values(study.set, files));
  common_ = common.hex();
  Hasher list;
  list.add(digest_of_values(study.set, files));
  for (const scenario::Factor& factor : study.factors) {
    list.add(factor.name);
    std::vector<std::string>& digests = levels_.emplace_back();
    for (const scenario::FactorLevel& level : factor.levels) {
      digests.push_back(digest_of_values(level.values, files));
      for (const std::string& text : level.texts) list.add(text);
      list.add(digests.back());
    }
  }
  for (const std::uint64_t seed : study.seeds) list.add(seed);
  design_digest_ = list.hex();
}

std::string Identity::whole() const {
  Hasher hasher;
  for (const std::string* part : {&common_, &design_digest_}) hasher.add(*part);
  return hasher.hex();
}

std::string Identity::of(std::size_t cell) const {
  Hasher hasher;
  hasher.add(common_);
  const std::vector<std::size_t> levels = design_.levels(design_.setting_of(cell));
  for (std::size_t k = 0; k < levels.size(); ++k) hasher.add(levels_[k][levels[k]]);
  hasher.add(design_.seed_of(cell));
  return hasher.hex();
}

}  // namespace vinerow::study
