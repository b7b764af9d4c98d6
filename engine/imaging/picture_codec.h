#pragma once
/// Pictures of camera sensors as PNG, without loss.

#include <string>
#include <string_view>

#include "engine/api/messages/camera.h"

namespace vinerow::imaging {

/// A PNG of 8-bit RGB, 8-bit or 16-bit grey. @returns "" if the picture is empty or its data do not
/// have its size
std::string encode_picture(const Picture& picture);

/// @returns false if the bytes are no such PNG
bool decode_picture(std::string_view png, Picture& picture);

}  // namespace vinerow::imaging
