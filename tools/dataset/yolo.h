#pragma once
/// Boxes as Ultralytics YOLO reads them: labels/<part>/<name>.txt with "class x y width height" in
/// shares of the picture (x, y: the box's middle), and data.yaml.

#include <filesystem>
#include <string>
#include <vector>

#include "tools/dataset/picture_record.h"

namespace vinerow::dataset {

/// @throws WriteError
void write_yolo_labels(const PictureRecord& picture, const std::filesystem::path& out);
/// @param parts  which of train, val and test have pictures
void write_yolo_data(const std::vector<std::string>& classes, const std::vector<bool>& parts,
                     const std::filesystem::path& out);

}  // namespace vinerow::dataset
