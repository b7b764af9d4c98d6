#include "engine/scenario/yaml_include.h"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <vector>

#include "engine/scenario/scenario_keys.h"

namespace vinerow::scenario {
namespace {

namespace fs = std::filesystem;

/// Chosen: far above the needs of any scenario. It bounds files that include each other many times
/// without a cycle.
constexpr int kMaxIncludes = 1000;

/// File on the current include chain, from the scenario down.
struct OpenFile {
  fs::path canonical;
  std::string shown_name;
};

class Includer {
 public:
  io::YamlNode load(const fs::path& file) {
    io::YamlNode root = io::load_yaml_file(file);
    check_root(root, file);
    open_.push_back({canonical(fs::absolute(file)), file.string()});
    resolve(root, "");
    open_.pop_back();
    return root;
  }

  void resolve(io::YamlNode& node, const std::string& path) {
    for (std::size_t i = 0; i < node.items.size(); ++i) {
      resolve(node.items[i], join_path(path, std::to_string(i)));
    }
    for (io::YamlEntry& entry : node.entries) {
      if (entry.key != "include") resolve(entry.value, join_path(path, entry.key));
    }
    const io::YamlEntry* include = node.find_entry("include");
    if (!include) return;

    const std::string include_path = join_path(path, "include");
    std::vector<io::YamlNode> files;
    if (include->value.is_list()) {
      files = include->value.items;
    } else {
      files.push_back(include->value);
    }
    io::YamlNode merged = io::yaml_mapping();
    merged.mark = node.mark;
    merged.folder = node.folder;
    for (const io::YamlNode& file : files) merge_over(merged, load_included(file, path), path);
    node.erase("include");
    merge_over(merged, std::move(node), path);
    node = std::move(merged);
  }

 private:
  static fs::path canonical(const fs::path& absolute) {
    std::error_code error;
    const fs::path result = fs::weakly_canonical(absolute, error);
    return error ? absolute.lexically_normal() : result;
  }

  static void check_root(const io::YamlNode& root, const fs::path& file) {
    if (root.is_null()) {
      io::fail_at({file.string(), 0},
                  "the file is empty; a scenario starts with 'vinerow: 1', a study with "
                  "'vinerow_study: 1'");
    }
    if (!root.is_mapping()) {
      io::fail_at(root.mark,
                  fmt::format("the file holds {}, must be a mapping ('key: value' lines)",
                              io::shown(root)));
    }
  }

  io::YamlNode load_included(const io::YamlNode& name, const std::string& path) {
    const std::string place = join_path(path, "include");
    if (!name.is_scalar() || !std::holds_alternative<std::string>(io::scalar_value(name)) ||
        name.text.empty()) {
      io::fail_at(name.mark,
                  fmt::format("{} = {}, must be the path of a file or a list of such paths", place,
                              io::shown(name)));
    }
    const fs::path wanted = (name.folder / name.text).lexically_normal();
    std::error_code error;
    if (!fs::is_regular_file(wanted, error)) {
      const char* what =
          fs::is_directory(wanted, error) ? "is a folder, not a file" : "no such file";
      io::fail_at(name.mark, fmt::format("{} = '{}': {} (looked for {}){}", place, name.text, what,
                                         wanted.string(), io::nearest_file_hint(wanted)));
    }
    const fs::path identity = canonical(wanted);
    // Shown relative to the including file's folder, so that the path in an error is valid from the
    // user's current folder.
    const fs::path parent_folder = fs::path(name.mark.file).parent_path();
    const std::string shown_name = fs::path(name.text).is_absolute() || open_.empty()
                                       ? wanted.string()
                                       : (parent_folder / name.text).lexically_normal().string();
    refuse_circle(name, place, identity, shown_name);
    if (++include_count_ > kMaxIncludes) {
      io::fail_at(name.mark, fmt::format("{} = '{}': more than {} files are included", place,
                                         name.text, kMaxIncludes));
    }
    io::YamlNode root = io::load_yaml_file_as(wanted, shown_name);
    if (root.is_null()) {
      io::fail_at(name.mark, fmt::format("{} = '{}': the file is empty", place, name.text));
    }
    check_root(root, shown_name);
    open_.push_back({identity, shown_name});
    resolve(root, path);
    open_.pop_back();
    return root;
  }

  void refuse_circle(const io::YamlNode& name, const std::string& place, const fs::path& identity,
                     const std::string& shown_name) const {
    const auto start = std::find_if(open_.begin(), open_.end(),
                                    [&](const auto& o) { return o.canonical == identity; });
    if (start == open_.end()) return;
    std::string chain;
    for (auto it = start; it != open_.end(); ++it) chain += it->shown_name + " -> ";
    io::fail_at(name.mark, fmt::format("{} = '{}': the files include each other in a cycle ({})",
                                       place, name.text, chain + shown_name));
  }

  std::vector<OpenFile> open_;
  int include_count_ = 0;
};

/// "vehicles.rover" but not "vehicles.rover.controller".
bool is_vehicle_path(const std::string& path) {
  return path.starts_with("vehicles.") && std::count(path.begin(), path.end(), '.') == 1;
}

bool is_spawn_path(const std::string& path) {
  return path.starts_with("vehicles.") && path.ends_with(".spawn") &&
         std::count(path.begin(), path.end(), '.') == 2;
}

bool differ(const io::YamlNode* a, const io::YamlNode* b) {
  return a && b && a->is_scalar() && b->is_scalar() && a->text != b->text;
}

bool replaces_whole(const io::YamlNode& base, const io::YamlNode& over, const std::string& path) {
  if (!base.is_mapping() || !over.is_mapping()) return true;
  if (is_sourced_value(base) && is_sourced_value(over)) return true;
  if (!is_vehicle_path(path) && differ(base.find("type"), over.find("type"))) return true;
  if (path.starts_with("pictures.cameras.") && differ(base.find("kind"), over.find("kind"))) {
    return true;
  }
  if (is_spawn_path(path)) {
    const std::string old_form = spawn_form_of(base), new_form = spawn_form_of(over);
    return !old_form.empty() && !new_form.empty() && old_form != new_form;
  }
  return false;
}

}  // namespace

std::string join_path(const std::string& path, const std::string& key) {
  return path.empty() ? key : path + "." + key;
}

bool is_sourced_value(const io::YamlNode& node) {
  return node.has("value") && std::all_of(node.entries.begin(), node.entries.end(), [](auto& e) {
           return e.key == "value" || e.key == "source";
         });
}

void merge_over(io::YamlNode& base, io::YamlNode over, const std::string& path) {
  if (replaces_whole(base, over, path)) {
    base = std::move(over);
    return;
  }
  base.mark = over.mark;
  for (io::YamlEntry& entry : over.entries) {
    const io::YamlEntry* existing = base.find_entry(entry.key);
    if (!existing) {
      base.entries.push_back(std::move(entry));
    } else if (entry.value.is_null()) {
      base.erase(entry.key);
    } else {
      auto& kept = const_cast<io::YamlEntry&>(*existing);
      kept.mark = entry.mark;
      merge_over(kept.value, std::move(entry.value), join_path(path, entry.key));
    }
  }
}

io::YamlNode load_yaml_with_includes(const fs::path& file) {
  return Includer().load(file);
}

void resolve_includes(io::YamlNode& tree, const std::string& path) {
  Includer().resolve(tree, path);
}

}  // namespace vinerow::scenario
