#pragma once
/// A ConfigError that knows where in the user's files the mistake is.

#include <string>

#include "engine/core/error.h"
#include "engine/io/files/source_mark.h"

namespace vinerow::io {

class PlacedError : public ConfigError {
 public:
  /// @param key  path of the parameter, "rover.controller.speed_mps"; "" if it is not about one
  PlacedError(SourceMark where, std::string key, const std::string& text)
      : ConfigError(text), where_(std::move(where)), key_(std::move(key)) {}

  const SourceMark& where() const { return where_; }
  const std::string& key() const { return key_; }

 private:
  SourceMark where_;
  std::string key_;
};

/// The key path that a sentence begins with ("a.b = 3, must be ...", "a.b: unknown ...", "a.b must
/// be given"), or "".
std::string leading_key(const std::string& sentence);

}  // namespace vinerow::io
