#include "engine/record/described_message.h"

#include "engine/core/check.h"
#include "engine/record/ros_definitions.h"

namespace vinerow::record {
namespace {

/// Writes a sensor's pose as the body's pose and the pose relative to the body. The body's pose has
/// the same bytes as in the truth message, so it compresses to almost nothing.
void write_pose_in_body(CdrWriter& out, const WriteContext& to, const Pose& X_WS) {
  write_pose(out, to.X_WB ? *to.X_WB : Pose{});
  write_pose(out, to.X_WB ? pose_in_body(*to.X_WB, X_WS) : X_WS);
}

std::size_t size_of(FieldKind kind) {
  switch (kind) {
    case FieldKind::kBool:
    case FieldKind::kInt8:
    case FieldKind::kUint8:
      return 1;
    case FieldKind::kInt16:
    case FieldKind::kUint16:
      return 2;
    case FieldKind::kInt32:
    case FieldKind::kUint32:
    case FieldKind::kFloat32:
      return 4;
    default:
      return 8;
  }
}

class WriteField final : public FieldVisitor {
 public:
  WriteField(CdrWriter& out, const WriteContext& to) : out_(out), to_(to) {}

  void field(const FieldView& view) override {
    if (view.shape == FieldShape::kSequence) out_.add_count(view.count);
    switch (view.kind) {
      case FieldKind::kText:
        for (std::size_t i = 0; i < view.count; ++i) {
          out_.add(std::string_view(view.value<std::string>(i)));
        }
        return;
      case FieldKind::kVector3:
        static_assert(sizeof(Eigen::Vector3d) == 3 * sizeof(double));
        out_.add_doubles(static_cast<const double*>(view.data), 3 * view.count);
        return;
      case FieldKind::kQuaternion:
        for (std::size_t i = 0; i < view.count; ++i) {
          write_quaternion(out_, view.value<Eigen::Quaterniond>(i));
        }
        return;
      case FieldKind::kPose:
        for (std::size_t i = 0; i < view.count; ++i) write(view.info, view.value<Pose>(i));
        return;
      case FieldKind::kRecord:
        for (std::size_t i = 0; i < view.count; ++i) view.visit_record(view.at(i), *this);
        return;
      default:
        out_.add_numbers(view.data, view.count, size_of(view.kind));
    }
  }

 private:
  void write(const FieldInfo& info, const Pose& pose) {
    if (info.relative_to_body) {
      write_pose_in_body(out_, to_, pose);
    } else {
      write_pose(out_, pose);
    }
  }

  CdrWriter& out_;
  const WriteContext& to_;
};

/// Visitor that collects the fields of a message to visit them in another order.
class SortFields final : public FieldVisitor {
 public:
  void field(const FieldView& view) override {
    VINEROW_DEMAND(count_ < fields_.size());
    fields_[count_++] = view;
  }
  void show(LogOrder order, FieldVisitor& visitor) const {
    VINEROW_DEMAND(order.size() == count_);
    for (const std::string_view name : order) {
      std::size_t i = 0;
      while (i < count_ && fields_[i].info.name != name) ++i;
      VINEROW_DEMAND(i < count_);
      visitor.field(fields_[i]);
    }
  }

 private:
  std::array<FieldView, 32> fields_;
  std::size_t count_ = 0;
};

void visit_in(LogOrder order, const MessageFields& message, FieldVisitor& visitor) {
  if (order.empty()) {
    message.visit(visitor);
    return;
  }
  SortFields sorted;
  message.visit(sorted);
  sorted.show(order, visitor);
}

const char* ros_name(FieldKind kind) {
  constexpr const char* kNames[] = {"bool",   "int8",   "int16",  "int32",   "int64",   "uint8",
                                    "uint16", "uint32", "uint64", "float32", "float64", "string"};
  return kNames[static_cast<int>(kind)];
}

/// Visitor that writes the .msg text of a message and of its nested messages.
class DefineField final : public FieldVisitor {
 public:
  DefineField(std::string package, std::vector<RosDefinition>& inside)
      : package_(std::move(package)), inside_(inside) {}

  void field(const FieldView& view) override {
    add_comment(view.info);
    for (const EnumName& name : view.names) {
      text_.append(ros_name(view.kind)).append(" ").append(name.name);
      text_.append("=").append(std::to_string(name.value)).append("\n");
    }
    if (view.info.relative_to_body) text_ += "geometry_msgs/Pose body\n";
    text_ += type_of(view);
    if (view.shape == FieldShape::kArray) text_ += "[" + std::to_string(view.count) + "]";
    if (view.shape == FieldShape::kSequence) text_ += "[]";
    text_.append(" ").append(view.info.name).append("\n");
  }
  const std::string& text() const { return text_; }

 private:
  void add_comment(const FieldInfo& info) {
    std::string comment(info.unit);
    if (!info.unit.empty() && !info.words.empty()) comment += ", ";
    comment += info.words;
    if (!comment.empty()) text_ += "# " + comment + "\n";
  }

  std::string type_of(const FieldView& view) {
    switch (view.kind) {
      case FieldKind::kVector3:
        return view.info.unit == "m" ? "geometry_msgs/Point" : "geometry_msgs/Vector3";
      case FieldKind::kQuaternion:
        return "geometry_msgs/Quaternion";
      case FieldKind::kPose:
        return "geometry_msgs/Pose";
      case FieldKind::kRecord:
        return define(view);
      default:
        return ros_name(view.kind);
    }
  }

  std::string define(const FieldView& view) {
    std::string type(view.record);
    if (type.find('/') == std::string::npos) type = package_ + "/" + type;
    for (const RosDefinition& known : inside_) {
      if (known.type == type) return type;
    }
    DefineField inner(package_, inside_);
    view.visit_record(nullptr, inner);
    inside_.push_back({type, inner.text()});
    return type;
  }

  std::string package_;
  std::vector<RosDefinition>& inside_;
  std::string text_;
};

}  // namespace

void write_described(CdrWriter& out, const WriteContext& to, MessageFrame frame, LogOrder order,
                     const MessageFields& message) {
  const FrameNames& names = to.frames;
  write_header(out, to.stamp,
               frame == MessageFrame::kBody    ? names.body
               : frame == MessageFrame::kWorld ? names.world
                                               : names.own);
  WriteField writer(out, to);
  visit_in(order, message, writer);
}

std::string ros_type_of(std::string_view message_type) {
  const std::size_t slash = message_type.find('/');
  if (slash == std::string_view::npos) return "vinerow_msgs/msg/" + std::string(message_type);
  return std::string(message_type.substr(0, slash)) + "/msg" +
         std::string(message_type.substr(slash));
}

std::string described_definition(std::string_view ros_type, LogOrder order,
                                 const MessageFields& message) {
  std::vector<RosDefinition> inside;
  DefineField define(std::string(ros_type.substr(0, ros_type.find('/'))), inside);
  visit_in(order, message, define);
  return full_ros_definition("std_msgs/Header header\n" + define.text(), inside);
}

void read_pose_in_body(CdrReader& in, Pose& X_WS) {
  Pose X_WB;
  read_pose(in, X_WB);
  read_pose(in, X_WS);
  // No multiplication by the identity, which would turn -0 into 0.
  const bool is_in_world = X_WB.p.isZero(0) && X_WB.q.coeffs() == Pose{}.q.coeffs();
  if (!is_in_world) X_WS = X_WB * X_WS;
}

}  // namespace vinerow::record
