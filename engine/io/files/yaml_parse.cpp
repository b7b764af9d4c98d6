#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <fstream>
#include <map>
#include <sstream>
#include <system_error>

#include "engine/core/error.h"
#include "engine/io/files/utf8.h"
#include "engine/io/files/yaml.h"

namespace vinerow::io {
namespace {

/// Aliases copy their values: without a limit, a file of a few lines could expand to gigabytes.
constexpr int kMaxNodes = 200'000;
constexpr std::uintmax_t kMaxFileBytes = 16u << 20;

/// Builder of the tree from the parser's events, which have marks and include duplicate keys.
class TreeBuilder : public YAML::EventHandler {
 public:
  TreeBuilder(std::string file_name, std::filesystem::path folder)
      : file_name_(std::move(file_name)), folder_(std::move(folder)) {}

  YamlNode take_root() { return std::move(root_); }

  /// Start line of the innermost open list or mapping; 0 if no list or mapping is open.
  int open_line() const { return open_.empty() ? 0 : open_.back().node.mark.line; }

  /// Line of the last value or key that was read.
  int last_line() const { return last_line_; }

  void OnDocumentStart(const YAML::Mark&) override {}
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    finish(new_node(YamlKind::kNull, mark), anchor);
  }

  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    const auto found = anchors_.find(anchor);
    if (found == anchors_.end()) fail(mark, "an alias is inside the value that it refers to");
    count_nodes(found->second, mark);
    finish(found->second, 0);
  }

  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    if (!tag.empty() && tag != "?" && tag != "!" && tag != "tag:yaml.org,2002:str") {
      fail(mark, fmt::format("the tag '{}' is not supported; write the value without it", tag));
    }
    YamlNode node = new_node(YamlKind::kScalar, mark);
    node.text = value;
    node.quoted = tag == "!" || tag == "tag:yaml.org,2002:str";
    finish(std::move(node), anchor);
  }

  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    open_.push_back({new_node(YamlKind::kList, mark), anchor, {}, {}, false});
  }
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    open_.push_back({new_node(YamlKind::kMapping, mark), anchor, {}, {}, false});
  }
  void OnSequenceEnd() override { close(); }
  void OnMapEnd() override { close(); }

 private:
  struct Open {
    YamlNode node;
    YAML::anchor_t anchor;
    std::string key;
    SourceMark key_mark;
    bool has_key;
  };

  SourceMark mark_of(const YAML::Mark& mark) const { return {file_name_, mark.line + 1}; }

  [[noreturn]] void fail(const YAML::Mark& mark, const std::string& sentence) const {
    fail_at(mark_of(mark), sentence);
  }

  YamlNode new_node(YamlKind kind, const YAML::Mark& mark) {
    YamlNode node;
    node.kind = kind;
    node.mark = mark_of(mark);
    node.folder = folder_;
    last_line_ = node.mark.line;
    count(mark);
    return node;
  }

  void count(const YAML::Mark& mark) {
    if (++node_count_ > kMaxNodes) {
      fail(mark, fmt::format("the file holds more than {} values", kMaxNodes));
    }
  }

  void count_nodes(const YamlNode& node, const YAML::Mark& mark) {
    count(mark);
    for (const YamlNode& item : node.items) count_nodes(item, mark);
    for (const YamlEntry& entry : node.entries) count_nodes(entry.value, mark);
  }

  void close() {
    Open done = std::move(open_.back());
    open_.pop_back();
    finish(std::move(done.node), done.anchor);
  }

  void finish(YamlNode node, YAML::anchor_t anchor) {
    if (anchor != 0) anchors_[anchor] = node;
    if (open_.empty()) {
      root_ = std::move(node);
      return;
    }
    Open& parent = open_.back();
    if (parent.node.is_list()) {
      parent.node.items.push_back(std::move(node));
    } else if (!parent.has_key) {
      take_key(parent, node);
    } else {
      parent.node.entries.push_back({std::move(parent.key), parent.key_mark, std::move(node)});
      parent.has_key = false;
    }
  }

  void take_key(Open& parent, const YamlNode& node) {
    if (!node.is_scalar() || node.text.empty()) {
      fail_at(node.mark, fmt::format("{} is in the place of a key", shown(node)));
    }
    if (!node.quoted && node.text == "<<") {
      fail_at(node.mark, "merge keys ('<<') are not supported; use 'include: file.yaml'");
    }
    if (const YamlEntry* first = parent.node.find_entry(node.text)) {
      fail_at(node.mark, fmt::format("the key '{}' is given twice in one mapping, first in line {}",
                                     node.text, first->mark.line));
    }
    parent.key = node.text;
    parent.key_mark = node.mark;
    parent.has_key = true;
  }

  std::string file_name_;
  std::filesystem::path folder_;
  std::vector<Open> open_;
  std::map<YAML::anchor_t, YamlNode> anchors_;
  YamlNode root_;
  int node_count_ = 0;
  int last_line_ = 1;
};

/// Checks for faults that the YAML parser accepts or describes badly.
void check_characters(const std::string& text, const std::string& file_name) {
  const std::string valid = valid_utf8(text);
  const auto wrong = std::mismatch(text.begin(), text.end(), valid.begin(), valid.end()).first;
  if (wrong != text.end()) {
    const auto line = 1 + static_cast<int>(std::count(text.begin(), wrong, '\n'));
    fail_at({file_name, line}, fmt::format("holds the byte 0x{:02x}, which is not UTF-8; save the "
                                           "file in this encoding",
                                           static_cast<unsigned char>(*wrong)));
  }
  int line = 1;
  bool in_indentation = true;
  bool indented_by_tab = false;
  for (const char c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (c == '\n') {
      ++line;
      in_indentation = true;
      indented_by_tab = false;
    } else if ((byte < 0x20 && c != '\t' && c != '\r') || byte == 0x7f) {
      fail_at({file_name, line},
              fmt::format("holds the control character 0x{:02x}; a scenario is plain text", byte));
    } else if (in_indentation && c == '\t') {
      indented_by_tab = true;
    } else if (in_indentation && c != ' ' && c != '\r') {
      in_indentation = false;
      if (indented_by_tab && c != '#') {
        fail_at({file_name, line}, "is indented with a tab; YAML is indented with spaces");
      }
    }
  }
}

/// Plain messages for the most common syntax errors.
std::string explain_yaml_fault(const YAML::Exception& fault, int open_line) {
  const auto not_closed = [&](const char* opening, const char* closing) {
    return fmt::format("the '{}' of line {} is not closed by '{}'", opening, open_line, closing);
  };
  if (open_line > 0 && fault.msg == YAML::ErrorMsg::END_OF_MAP_FLOW) return not_closed("{", "}");
  if (open_line > 0 && fault.msg == YAML::ErrorMsg::END_OF_SEQ_FLOW) return not_closed("[", "]");
  if (fault.msg == YAML::ErrorMsg::FLOW_END) return "a '}' or ']' without its opening bracket";
  if (fault.msg == YAML::ErrorMsg::MAP_VALUE) {
    return "a ':' is not allowed here: is a text with ': ' not in quotes?";
  }
  if (fault.msg == YAML::ErrorMsg::END_OF_MAP) {
    return "a key is expected here: is this line indented as those above it?";
  }
  return fault.msg;
}

}  // namespace

YamlNode parse_yaml(const std::string& text, const std::string& file_name,
                    const std::filesystem::path& folder) {
  check_characters(text, file_name);
  // The end mark makes the parser refuse a quotation mark that no other closes.
  std::istringstream stream(text + "\n...\n");
  TreeBuilder builder(file_name, folder);
  try {
    YAML::Parser parser(stream);
    if (!parser.HandleNextDocument(builder)) return {};
    YamlNode root = builder.take_root();
    TreeBuilder second(file_name, folder);
    if (parser.HandleNextDocument(second)) {
      fail_at({file_name, second.take_root().mark.line},
              "starts a second document ('---'); a file holds one");
    }
    return root;
  } catch (const YAML::Exception& fault) {
    if (fault.msg == YAML::ErrorMsg::DOC_IN_SCALAR) {
      fail_at({file_name, builder.last_line()},
              "is not valid YAML: a quotation mark from here on is not closed");
    }
    const int line = fault.mark.is_null() ? 0 : fault.mark.line + 1;
    fail_at({file_name, line},
            fmt::format("is not valid YAML: {}", explain_yaml_fault(fault, builder.open_line())));
  }
}

YamlNode load_yaml_file(const std::filesystem::path& file) {
  return load_yaml_file_as(file, file.string());
}

YamlNode load_yaml_file_as(const std::filesystem::path& file, const std::string& shown_name) {
  const SourceMark whole_file{shown_name, 0};
  std::error_code error;
  const std::filesystem::path absolute = std::filesystem::absolute(file, error).lexically_normal();
  if (!std::filesystem::exists(absolute, error)) {
    fail_at(whole_file, "no such file" + nearest_file_hint(absolute));
  }
  if (std::filesystem::is_directory(absolute, error))
    fail_at(whole_file, "is a folder, not a file");
  const std::uintmax_t size = std::filesystem::file_size(absolute, error);
  if (!error && size > kMaxFileBytes) {
    fail_at(whole_file, fmt::format("is {} bytes long, at most {} are read", size, kMaxFileBytes));
  }
  std::ifstream stream(absolute, std::ios::binary);
  std::ostringstream text;
  text << stream.rdbuf();
  if (!stream) fail_at(whole_file, "cannot be read");
  return parse_yaml(text.str(), shown_name, absolute.parent_path());
}

}  // namespace vinerow::io
