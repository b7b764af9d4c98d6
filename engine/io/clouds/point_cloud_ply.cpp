#include "engine/io/clouds/point_cloud_ply.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>
#include <vector>

#include "engine/io/clouds/ply_header.h"

namespace vinerow::io {
namespace {

/// Meaning of a vertex property for a point.
enum class Role { kX, kY, kZ, kRed, kGreen, kBlue, kClass, kNone };
constexpr std::size_t kRoles = 7;

Role role_of(const PlyProperty& property) {
  if (property.list_count_type) return Role::kNone;
  const std::string& name = property.name;
  if (name == "x") return Role::kX;
  if (name == "y") return Role::kY;
  if (name == "z") return Role::kZ;
  if (name == "red" || name == "r" || name == "diffuse_red") return Role::kRed;
  if (name == "green" || name == "g" || name == "diffuse_green") return Role::kGreen;
  if (name == "blue" || name == "b" || name == "diffuse_blue") return Role::kBlue;
  if (name == "classification" || name == "class" || name == "label" ||
      name == "scalar_Classification" || name == "scalar_classification") {
    return Role::kClass;
  }
  return Role::kNone;
}

class PlyReader : public PointCloudReader {
 public:
  explicit PlyReader(BlockFile file) : file_(std::move(file)), header_(read_ply_header(file_)) {
    std::size_t k = 0;
    while (k < header_.elements.size() && header_.elements[k].name != "vertex") ++k;
    if (k == header_.elements.size()) file_.fail("has no element 'vertex'");
    vertex_ = &header_.elements[k];
    learn_roles();
    for (std::size_t before = 0; before < k; ++before) skip(header_.elements[before]);
    if (!header_.ascii && !vertex_->has_lists()) check_size(k + 1 == header_.elements.size());
    last_ = k + 1 == header_.elements.size();
    info_.format = header_.ascii ? "PLY ascii" : "PLY binary";
    info_.record_count = vertex_->count;
  }

 protected:
  Next next(CloudPoint& point) override {
    if (at_ == vertex_->count) {
      std::string_view line;
      if (header_.ascii && last_ && next_line(file_, &line)) {
        file_.fail(fmt::format("has more data than its header counts: {} points, then line {}",
                               vertex_->count, file_.line_number()));
      }
      return Next::kEnd;
    }
    if (header_.ascii) {
      read_text(*vertex_, at_);
    } else if (fixed_bytes_ != 0) {
      read_fixed();
    } else {
      read_bytes(*vertex_, at_);
    }
    ++at_;
    point.position = {values_[0], values_[1], values_[2]};
    point.rgb.reset();
    point.classification.reset();
    if (info_.has_colour) {
      point.rgb = {{colour(Role::kRed), colour(Role::kGreen), colour(Role::kBlue)}};
    }
    if (info_.has_classification) point.classification = classification();
    return Next::kPoint;
  }

 private:
  void learn_roles() {
    std::array<bool, kRoles + 1> has{};
    std::size_t at = 0;
    for (const PlyProperty& property : vertex_->properties) {
      const Role role = role_of(property);
      const auto k = static_cast<std::size_t>(role);
      if (role != Role::kNone && has[k]) {
        file_.fail(fmt::format("has the property '{}' twice", property.name));
      }
      has[k] = true;
      if (role != Role::kNone) {
        types_[k] = property.type;
        places_[k] = at;
      }
      at += size_of(property.type);
      roles_.push_back(role);
    }
    if (!vertex_->has_lists()) fixed_bytes_ = at;
    for (std::size_t k = 0; k < 3; ++k) {
      if (!has[k]) file_.fail(fmt::format("has no property '{}' of its vertices", "xyz"[k]));
    }
    info_.has_colour = has[3] && has[4] && has[5];
    info_.has_classification = has[6];
  }

  /// Checks the file's size before the first vertex is read, if vertices have a fixed size.
  void check_size(bool nothing_follows) const {
    const std::uint64_t bytes = vertex_->fixed_bytes();
    const std::uint64_t held = file_.remaining() / bytes;
    if (held < vertex_->count) fail_cut_off(held);
    if (nothing_follows && held > vertex_->count) {
      file_.fail(fmt::format("has more data than its header counts: {} points, it holds {}",
                             vertex_->count, held));
    }
  }
  [[noreturn]] void fail_cut_off(std::uint64_t held) const {
    file_.fail(
        fmt::format("is cut off: its header counts {} points, it holds {}", vertex_->count, held));
  }
  [[noreturn]] void fail_cut_off(const PlyElement& element, std::uint64_t held) const {
    if (&element == vertex_) fail_cut_off(held);
    file_.fail(fmt::format("is cut off: its header counts {} of the element '{}', it holds {}",
                           element.count, element.name, held));
  }

  /// Skips an element before the vertices.
  void skip(const PlyElement& element) {
    if (element.properties.empty()) return;  // takes no bytes for any count
    if (!header_.ascii && !element.has_lists()) {
      const std::uint64_t bytes = element.fixed_bytes();
      if (file_.remaining() / bytes < element.count) {
        fail_cut_off(element, file_.remaining() / bytes);
      }
      file_.seek(file_.position() + bytes * element.count);
      return;
    }
    for (std::uint64_t k = 0; k < element.count; ++k) {
      std::string_view line;
      if (!header_.ascii) {
        read_bytes(element, k);
      } else if (!next_line(file_, &line)) {
        fail_cut_off(element, k);
      }
    }
  }

  /// Reads a vertex without lists; its numbers are at fixed offsets.
  void read_fixed() {
    const std::uint8_t* bytes = file_.take(fixed_bytes_);
    if (bytes == nullptr) fail_cut_off(at_);
    for (std::size_t k = 0; k < kRoles; ++k) {
      if (places_[k]) values_[k] = load(types_[k], bytes + *places_[k], header_.order);
    }
  }

  void read_bytes(const PlyElement& element, std::uint64_t index) {
    const bool is_vertex = &element == vertex_;
    for (std::size_t k = 0; k < element.properties.size(); ++k) {
      const PlyProperty& property = element.properties[k];
      const Scalar first = property.list_count_type.value_or(property.type);
      const std::uint8_t* bytes = file_.take(size_of(first));
      if (bytes == nullptr) fail_cut_off(element, index);
      const double value = load(first, bytes, header_.order);
      if (property.list_count_type) {
        skip_list(element, index, property, value);
      } else if (is_vertex && roles_[k] != Role::kNone) {
        values_[static_cast<std::size_t>(roles_[k])] = value;
      }
    }
  }
  void skip_list(const PlyElement& element, std::uint64_t index, const PlyProperty& property,
                 double count) {
    if (count < 0.0) {
      file_.fail(fmt::format("has a list '{}' of {} values in '{}' {}", property.name, count,
                             element.name, index + 1));
    }
    const std::size_t bytes = size_of(property.type);
    if (count > static_cast<double>(file_.remaining() / bytes)) fail_cut_off(element, index);
    file_.seek(file_.position() + bytes * static_cast<std::uint64_t>(count));
  }

  void read_text(const PlyElement& element, std::uint64_t index) {
    std::string_view line;
    if (!next_line(file_, &line)) fail_cut_off(element, index);
    for (std::size_t k = 0; k < element.properties.size(); ++k) {
      const PlyProperty& property = element.properties[k];
      const double value = number_in(file_, next_word(&line), property.name);
      if (property.list_count_type) {
        for (double left = value; left > 0.0; left -= 1.0) {
          number_in(file_, next_word(&line), property.name);
        }
      } else if (roles_[k] != Role::kNone) {
        values_[static_cast<std::size_t>(roles_[k])] = value;
      }
    }
  }

  std::uint8_t colour(Role role) const {
    const auto k = static_cast<std::size_t>(role);
    const Scalar type = types_[k];
    const double max_value = is_real(type) ? 1.0 : size_of(type) == 2 ? 65535.0 : 255.0;
    if (!(values_[k] >= 0.0 && values_[k] <= max_value)) {
      file_.fail(fmt::format("has a colour of {} at point {}, must be 0 to {}", values_[k], at_,
                             max_value));
    }
    return static_cast<std::uint8_t>(std::lround(values_[k] * (255.0 / max_value)));
  }
  /// Only numbers from 0 to 255 are LAS classes; others are ignored.
  std::optional<std::uint8_t> classification() const {
    const double value = values_[static_cast<std::size_t>(Role::kClass)];
    if (!(value >= 0.0 && value <= 255.0) || value != std::floor(value)) return std::nullopt;
    return static_cast<std::uint8_t>(value);
  }

  BlockFile file_;
  PlyHeader header_;
  const PlyElement* vertex_ = nullptr;
  std::vector<Role> roles_;  // of the vertex properties
  std::array<Scalar, kRoles> types_{};
  std::array<std::optional<std::size_t>, kRoles> places_{};  // byte in a vertex without lists
  std::size_t fixed_bytes_ = 0;          // of such a vertex; 0: vertices have lists
  std::array<double, kRoles> values_{};  // of the last vertex, by role
  std::uint64_t at_ = 0;
  bool last_ = false;  // no element follows the vertices
};

}  // namespace

std::unique_ptr<PointCloudReader> open_ply(BlockFile file) {
  return std::make_unique<PlyReader>(std::move(file));
}

}  // namespace vinerow::io
