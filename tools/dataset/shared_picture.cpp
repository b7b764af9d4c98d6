#include "tools/dataset/shared_picture.h"

#include <fmt/format.h>

#include <system_error>

#include "engine/core/whole_file.h"

namespace vinerow::dataset {

void share_picture(const PictureRecord& picture, const std::filesystem::path& out,
                   const std::filesystem::path& target) {
  const std::filesystem::path source = out / "images" / to_string(picture.split) / picture.name();
  std::error_code failed;
  std::filesystem::create_hard_link(source, target, failed);
  if (!failed) return;
  failed.clear();
  std::filesystem::copy_file(source, target, failed);
  if (failed) throw_cannot_write(fmt::format("'{}'", target.string()), failed.value());
}

}  // namespace vinerow::dataset
