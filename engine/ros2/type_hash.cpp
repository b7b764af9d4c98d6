#include "engine/ros2/type_hash.h"

#include <fmt/format.h>
#include <openssl/evp.h>

#include <array>
#include <set>

#include "engine/core/check.h"
#include "engine/ros2/type_description.h"

namespace vinerow::ros2 {
namespace {

// The hash is of this exact text: blanks after ',' and ':', keys in this order. Names are
// identifiers, so nothing needs an escape.
std::string json_of(const std::string& name, const std::vector<FieldDescription>& fields) {
  std::string json = fmt::format(R"({{"type_name": "{}", "fields": [)", name);
  std::string_view separator;
  for (const FieldDescription& field : fields) {
    json += fmt::format(
        R"({}{{"name": "{}", "type": {{"type_id": {}, "capacity": {}, "string_capacity": {}, )"
        R"("nested_type_name": "{}"}}}})",
        separator, field.name, field.type_id, field.capacity, field.text_capacity,
        field.nested_type);
    separator = ", ";
  }
  return json + "]}";
}

/// All types that `name` uses, in alphabetical order, without itself.
std::set<std::string> used_types(const TypeDescriptions& types, const std::string& name) {
  std::set<std::string> used;
  std::vector<std::string> open = {name};
  while (!open.empty()) {
    const std::string type = std::move(open.back());
    open.pop_back();
    for (const FieldDescription& field : types.at(type)) {
      if (field.nested_type.empty() || !used.insert(field.nested_type).second) continue;
      open.push_back(field.nested_type);
    }
  }
  return used;
}

std::string sha256(std::string_view text) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned int size = 0;
  VINEROW_DEMAND(
      EVP_Digest(text.data(), text.size(), digest.data(), &size, EVP_sha256(), nullptr) == 1);
  std::string hex;
  for (unsigned int i = 0; i < size; ++i) hex += fmt::format("{:02x}", digest[i]);
  return hex;
}

std::string hash_of(const TypeDescriptions& types, const std::string& name) {
  std::string json = fmt::format(R"({{"type_description": {}, "referenced_type_descriptions": [)",
                                 json_of(name, types.at(name)));
  std::string_view separator;
  for (const std::string& type : used_types(types, name)) {
    json += fmt::format("{}{}", separator, json_of(type, types.at(type)));
    separator = ", ";
  }
  return "RIHS01_" + sha256(json + "]}");
}

}  // namespace

std::string message_type_hash(std::string_view name, std::string_view text) {
  return hash_of(describe_message(name, text), std::string(name));
}

ServiceTypeHashes service_type_hashes(std::string_view name, std::string_view text) {
  const TypeDescriptions types = describe_service(name, text);
  const std::string service(name);
  return {hash_of(types, service), hash_of(types, service + "_Request"),
          hash_of(types, service + "_Response")};
}

}  // namespace vinerow::ros2
