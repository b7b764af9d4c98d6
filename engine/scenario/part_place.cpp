#include <cctype>
#include <string_view>
#include <tuple>

#include "engine/scenario/scenario.h"

namespace vinerow::scenario {
namespace {

bool is_of_word(char c) {
  return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_';
}

/// Where the sentence names the key, or npos. A key that is a plain word may be a word of the
/// sentence: it counts only where it stands as a key, "camera = ...", "vines: ...", "vines.bbch",
/// "outages[0]" or in quotes.
std::size_t find_key(std::string_view sentence, const std::string& key) {
  for (std::size_t at = sentence.find(key); at != std::string_view::npos;
       at = sentence.find(key, at + 1)) {
    const std::string_view rest = sentence.substr(at + key.size());
    const bool is_whole =
        (at == 0 || !is_of_word(sentence[at - 1])) && (rest.empty() || !is_of_word(rest.front()));
    if (!is_whole) continue;
    if (key.find('_') != std::string::npos) return at;
    const bool has_field = rest.size() > 1 && rest[0] == '.' && is_of_word(rest[1]);
    if (has_field || rest.starts_with(" = ") || rest.starts_with(": ") || rest.starts_with("[") ||
        rest.starts_with("'") || rest.starts_with(" has ") || rest.starts_with(" names ")) {
      return at;
    }
  }
  return std::string_view::npos;
}

}  // namespace

const io::SourceMark& PartConfig::place_of(const std::string& sentence) const {
  const io::SourceMark* best = &where;
  // Values of a study or --set first, then fields before their group, then the first that is named.
  std::tuple<bool, bool, std::size_t> best_rank = {true, true, std::string::npos};
  for (const GivenKey& key : given) {
    const std::size_t at = find_key(sentence, key.name);
    // Values that a program sets have no place.
    if (at == std::string::npos || key.where.file.empty()) continue;
    const std::tuple<bool, bool, std::size_t> rank = {!key.where.is_override, key.is_group, at};
    if (rank >= best_rank) continue;
    best = &key.where;
    best_rank = rank;
  }
  return *best;
}

}  // namespace vinerow::scenario
