#include "engine/core/hash.h"
#include "engine/imaging/png.h"
#include "engine/render/scene.h"

namespace vinerow::render {

void write_png(const std::string& file, const Image& image,
               const std::map<std::string, std::string>& words) {
  imaging::write_png(file, image.width, image.height, image.rgb, words);
}

std::string image_digest(const Image& image) {
  Hasher hasher;
  hasher.add(image.width);
  hasher.add(image.height);
  hasher.add_bytes(image.rgb.data(), image.rgb.size());
  return hasher.hex();
}

}  // namespace vinerow::render
