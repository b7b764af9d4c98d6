#pragma once
/// Pictures of a data set under a second name.

#include <filesystem>

#include "tools/dataset/picture_record.h"

namespace vinerow::dataset {

/// Gives a picture a second name: the same file, where the file system can, else a copy.
/// @param out  of the data set, with images/  @param target  in a folder that exists
/// @throws WriteError
void share_picture(const PictureRecord& picture, const std::filesystem::path& out,
                   const std::filesystem::path& target);

}  // namespace vinerow::dataset
