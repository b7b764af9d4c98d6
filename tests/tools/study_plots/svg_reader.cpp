#include "tests/tools/study_plots/svg_reader.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <numbers>
#include <stdexcept>
#include <string_view>

#include "engine/io/files/utf8.h"
#include "tools/study/plots/text_fit.h"

namespace vinerow::study::testing {
namespace {

bool is_name(std::string_view name) {
  return !name.empty() &&
         name.find_first_not_of(
             "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789-:_") ==
             std::string_view::npos;
}

/// Throws where a text has a letter that XML does not allow, or a stray "<" or "&".
void check_text(std::string_view text) {
  for (std::size_t i = 0; i < text.size(); ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    if (byte < 0x20 && byte != '\n' && byte != '\t') throw std::runtime_error("control character");
    if (byte == '<') throw std::runtime_error("stray <");
    if (byte != '&') continue;
    const std::string_view rest = text.substr(i);
    const bool known = rest.starts_with("&amp;") || rest.starts_with("&lt;") ||
                       rest.starts_with("&gt;") || rest.starts_with("&quot;") ||
                       rest.starts_with("&apos;");
    if (!known) throw std::runtime_error("stray &");
  }
}

class Reader {
 public:
  explicit Reader(std::string_view text) : text_(text) {}

  std::vector<Element> read() {
    while (at_ < text_.size()) {
      const std::size_t next = std::min(text_.find('<', at_), text_.size());
      const std::string_view text = text_.substr(at_, next - at_);
      check_text(text);
      if (!open_.empty()) {
        elements_[open_.back()].text += text;
      } else if (text.find_first_not_of(" \n") != std::string_view::npos) {
        throw std::runtime_error("text outside of the root");
      }
      at_ = next;
      if (at_ < text_.size()) read_tag();
    }
    if (!open_.empty()) throw std::runtime_error("open: " + elements_[open_.back()].name);
    return elements_;
  }

 private:
  void read_tag() {
    const std::size_t end = text_.find('>', at_);
    if (end == std::string_view::npos) throw std::runtime_error("no >");
    std::string_view tag = text_.substr(at_ + 1, end - at_ - 1);
    at_ = end + 1;
    if (tag.starts_with('/')) {
      if (open_.empty() || elements_[open_.back()].name != tag.substr(1)) {
        throw std::runtime_error("closed, not open: " + std::string(tag));
      }
      open_.pop_back();
      return;
    }
    const bool empty = tag.ends_with('/');
    if (empty) tag.remove_suffix(1);
    elements_.push_back(read_element(tag));
    if (!empty) open_.push_back(elements_.size() - 1);
  }

  static Element read_element(std::string_view tag) {
    Element element;
    element.name = tag.substr(0, tag.find(' '));
    if (!is_name(element.name)) throw std::runtime_error("name: " + element.name);
    tag.remove_prefix(element.name.size());
    while (!tag.empty()) {
      const std::size_t equals = tag.find("=\"");
      if (!tag.starts_with(' ') || equals == std::string_view::npos) {
        throw std::runtime_error("attributes: " + std::string(tag));
      }
      const std::string name(tag.substr(1, equals - 1));
      const std::size_t end = tag.find('"', equals + 2);
      if (!is_name(name) || end == std::string_view::npos) {
        throw std::runtime_error("attribute: " + name);
      }
      const std::string_view value = tag.substr(equals + 2, end - equals - 2);
      check_text(value);
      if (!element.attributes.emplace(name, value).second) {
        throw std::runtime_error("twice: " + name);
      }
      tag.remove_prefix(end + 1);
    }
    return element;
  }

  std::string_view text_;
  std::size_t at_ = 0;
  std::vector<Element> elements_;
  std::vector<std::size_t> open_;
};

/// Where a text lies, px, y down.
struct TextBox {
  std::string text;
  double left, right, top, bottom;
};

std::string unescaped(std::string text) {
  for (const auto& [entity, letter] :
       {std::pair{"&lt;", "<"}, {"&gt;", ">"}, {"&quot;", "\""}, {"&amp;", "&"}}) {
    for (std::size_t at = 0; (at = text.find(entity)) != std::string::npos;) {
      text.replace(at, std::strlen(entity), letter);
    }
  }
  return text;
}

TextBox box_of(const Element& text) {
  const double size = text.is("value") ? 12.0 : text.is("tick") ? kTick_px : kLabel_px;
  const double width = widest_px(unescaped(text.text), size);
  if (!text.has("transform")) {
    const double x = text.number("x"), y = text.number("y");
    const double left = text.is("end")                       ? x - width
                        : text.is("mid") || text.is("value") ? x - 0.5 * width
                                                             : x;
    return {text.text, left, left + width, y - 0.75 * size, y + 0.2 * size};
  }
  double x = 0.0, y = 0.0, degrees = 0.0;
  std::sscanf(text.attributes.at("transform").c_str(), "translate(%lf %lf) rotate(%lf)", &x, &y,
              &degrees);
  if (degrees == -90.0) {
    return {text.text, x - 0.75 * size, x + 0.2 * size, y - 0.5 * width, y + 0.5 * width};
  }
  // Slanted, ending at (x, y): the box around it.
  const double along = width / std::numbers::sqrt2;
  return {text.text, x - along, x, y - 8.0, y + along};
}

bool is_slanted(const Element& text) {
  return text.has("transform") &&
         text.attributes.at("transform").find("rotate(-45)") != std::string::npos;
}

}  // namespace

double Element::number(const std::string& attribute) const {
  return std::stod(attributes.at(attribute));
}

bool Element::is(const std::string& css_class) const {
  const auto found = attributes.find("class");
  return found != attributes.end() &&
         (" " + found->second + " ").find(" " + css_class + " ") != std::string::npos;
}

std::vector<Element> Document::with_class(const std::string& css_class) const {
  std::vector<Element> out;
  std::copy_if(elements.begin(), elements.end(), std::back_inserter(out),
               [&](const Element& element) { return element.is(css_class); });
  return out;
}

std::vector<Element> Document::with_cell() const {
  std::vector<Element> out;
  std::copy_if(elements.begin(), elements.end(), std::back_inserter(out),
               [&](const Element& element) { return element.has("data-cell"); });
  return out;
}

std::vector<Element> Document::named(const std::string& name) const {
  std::vector<Element> out;
  std::copy_if(elements.begin(), elements.end(), std::back_inserter(out),
               [&](const Element& element) { return element.name == name; });
  return out;
}

Document read_xml(const std::string& text) {
  Document document;
  if (io::valid_utf8(text) != text) {
    document.fault = "no UTF-8";
    return document;
  }
  try {
    document.elements = Reader(text).read();
  } catch (const std::exception& fault) {
    document.fault = fault.what();
  }
  return document;
}

std::string overlaps(const Document& svg) {
  std::string out;
  double width = 0.0, height = 0.0;
  std::vector<TextBox> boxes;
  std::vector<double> slanted;  // the lines' places across, px
  for (const Element& element : svg.elements) {
    if (element.name == "svg") {
      std::sscanf(element.attributes.at("viewBox").c_str(), "0 0 %lf %lf", &width, &height);
    }
    if (element.name != "text" || element.text.empty()) continue;
    const TextBox box = box_of(element);
    if (box.left < -1.0 || box.right > width + 1.0 || box.top < -1.0 || box.bottom > height + 1.0) {
      out +=
          fmt::format("beyond the picture: {} at {:.0f} to {:.0f}, {:.0f} to {:.0f} of {} x {}\n",
                      box.text, box.left, box.right, box.top, box.bottom, width, height);
    }
    if (!is_slanted(element)) {
      boxes.push_back(box);
      continue;
    }
    // Lines x + y = constant, reading up to the right.
    const double across = (box.right + box.top + 8.0) / std::numbers::sqrt2;
    for (const double other : slanted) {
      if (std::abs(across - other) < kTick_px) out += "too near: " + box.text + "\n";
    }
    slanted.push_back(across);
  }
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const TextBox &a = boxes[i], &b = boxes[j];
      if (a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom) {
        out += a.text + " overlaps " + b.text + "\n";
      }
    }
  }
  return out;
}

}  // namespace vinerow::study::testing
