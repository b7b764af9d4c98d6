#include "engine/mavlink/dialect.h"

#include <algorithm>
#include <array>

#include "engine/mavlink/messages.h"

namespace vinerow::mavlink {
namespace {

template <class... Messages>
constexpr auto layouts_of(MessageList<Messages...>) {
  std::array all = {MessageLayout{Messages::kId, Messages::kName, crc_extra<Messages>(),
                                  payload_size<Messages>()}...};
  std::sort(all.begin(), all.end(), [](const auto& a, const auto& b) { return a.id < b.id; });
  return all;
}

constexpr auto kLayouts = layouts_of(AllMessages{});

}  // namespace

std::span<const MessageLayout> known_messages() {
  return kLayouts;
}

const MessageLayout* find_message(std::uint32_t id) {
  const auto at = std::lower_bound(
      kLayouts.begin(), kLayouts.end(), id,
      [](const MessageLayout& layout, std::uint32_t wanted) { return layout.id < wanted; });
  return at != kLayouts.end() && at->id == id ? &*at : nullptr;
}

}  // namespace vinerow::mavlink
