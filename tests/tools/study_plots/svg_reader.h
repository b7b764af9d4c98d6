#pragma once
/// Reads what plots write: whether it is well formed, its elements, where its texts lie.

#include <map>
#include <string>
#include <vector>

namespace vinerow::study::testing {

struct Element {
  std::string name;
  std::map<std::string, std::string> attributes;  ///< as written, escaped
  std::string text;                               ///< of its own, as written

  bool has(const std::string& attribute) const { return attributes.count(attribute) > 0; }
  double number(const std::string& attribute) const;
  /// Whether its class has that word.
  bool is(const std::string& css_class) const;
};

struct Document {
  std::string fault;              ///< what is not well formed; "" where nothing is
  std::vector<Element> elements;  ///< in the order of their beginnings

  std::vector<Element> with_class(const std::string& css_class) const;
  std::vector<Element> with_cell() const;
  std::vector<Element> named(const std::string& name) const;
};

/// By the rules of XML 1.0 for elements, attributes, characters and the five entities. UTF-8.
Document read_xml(const std::string& text);

/// Pairs of level texts that overlap, and texts beyond the picture, one a line; "" where there are
/// none. Of slanted texts: those whose lines are nearer than a letter is high.
std::string overlaps(const Document& svg);

}  // namespace vinerow::study::testing
