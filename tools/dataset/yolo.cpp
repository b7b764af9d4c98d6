#include "tools/dataset/yolo.h"

#include <fmt/format.h>

#include "engine/core/whole_file.h"
#include "engine/io/files/output_folder.h"

namespace vinerow::dataset {

void write_yolo_labels(const PictureRecord& picture, const std::filesystem::path& out) {
  std::string text;
  const double w = picture.camera.width, h = picture.camera.height;
  for (const Annotation& thing : picture.things) {
    const Mask& mask = thing.mask;
    text += fmt::format("{} {:.6f} {:.6f} {:.6f} {:.6f}\n", thing.class_index,
                        (mask.left + 0.5 * mask.width) / w, (mask.top + 0.5 * mask.height) / h,
                        mask.width / w, mask.height / h);
  }
  // A picture without things has an empty file: it is background.
  const std::filesystem::path file =
      (out / "labels" / to_string(picture.split) / picture.name()).replace_extension(".txt");
  io::make_folder_of(file);
  write_whole_file(file, text);
}

void write_yolo_data(const std::vector<std::string>& classes, const std::vector<bool>& parts,
                     const std::filesystem::path& out) {
  std::string text = "# Boxes in labels/. Paths start at this file's folder.\n";
  for (std::size_t s = 0; s < parts.size(); ++s) {
    if (parts[s]) text += fmt::format("{0}: images/{0}\n", kSplitNames[s]);
  }
  // Training demands `val`.
  if (!parts[static_cast<std::size_t>(Split::kValidation)]) text += "val: images/train\n";
  text += "names:\n";
  for (std::size_t i = 0; i < classes.size(); ++i) {
    text += fmt::format("  {}: {}\n", i, classes[i]);
  }
  write_whole_file(out / "data.yaml", text);
}

}  // namespace vinerow::dataset
