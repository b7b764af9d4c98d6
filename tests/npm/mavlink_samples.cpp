// mavlink_samples write FOLDER   frames.bin with a frame of every message, frames.json with the
// values of their fields mavlink_samples read FILE      prints the values of the frames in a file,
// in the same form Values are whole numbers, for floats eighths: no conversion rounds them.
#include <fmt/format.h>

#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "engine/mavlink/dialect.h"
#include "engine/mavlink/frame.h"
#include "engine/mavlink/messages.h"

namespace {

using namespace vinerow::mavlink;

/// Numbers that fill every byte, negative ones included.
std::uint64_t next_number() {
  static std::uint64_t state = 1;
  state = state * 6364136223846793005ULL + 1442695040888963407ULL;
  return state ^ (state >> 29);
}

template <class T>
void fill(T& value) {
  if constexpr (std::is_floating_point_v<T>) {
    value = static_cast<T>(static_cast<std::int32_t>(next_number() % 2'000'001) - 1'000'000) / 8;
  } else if constexpr (std::same_as<T, char>) {
    value = static_cast<char>('a' + next_number() % 26);
  } else {
    value = static_cast<T>(next_number());
  }
}
template <class T, std::size_t N>
void fill(std::array<T, N>& values) {
  for (T& value : values) fill(value);
}

template <class T>
std::string json(const T& value) {
  if constexpr (sizeof(T) == 8 && std::is_integral_v<T>) return fmt::format("\"{}\"", value);
  return fmt::format("{}", value);
}
template <class T, std::size_t N>
std::string json(const std::array<T, N>& values) {
  if constexpr (std::same_as<T, char>) return fmt::format("\"{}\"", text_of(values));
  std::string list;
  for (const T& value : values) list += (list.empty() ? "" : ", ") + json(value);
  return "[" + list + "]";
}

template <class M>
std::string describe(const M& message) {
  std::string fields;
  M::fields(message, [&](Field field, const auto& value) {
    fields += fmt::format("{}\"{}\": {}", fields.empty() ? "" : ", ", field.name, json(value));
  });
  return fmt::format(R"({{"id": {}, "name": "{}", "crc_extra": {}, "size": {}, "fields": {{{}}}}})",
                     M::kId, M::kName, crc_extra<M>(), payload_size<M>(), fields);
}

std::string joined(const std::vector<std::string>& rows) {
  return fmt::format("[\n{}\n]\n", fmt::join(rows, ",\n"));
}

template <class... Messages>
void write_all(MessageList<Messages...>, const std::filesystem::path& folder) {
  std::ofstream frames(folder / "frames.bin", std::ios::binary);
  std::vector<std::string> rows;
  FrameWriter writer({42, 7});
  const auto write = [&]<class M>(M message) {
    M::fields(message, [](Field, auto& value) { fill(value); });
    const auto bytes = writer.write(message);
    frames.write(reinterpret_cast<const char*>(bytes.data()),
                 static_cast<std::streamsize>(bytes.size()));
    rows.push_back(describe(message));
  };
  (write(Messages{}), ...);
  std::ofstream(folder / "frames.json") << joined(rows);
}

template <class... Messages>
std::string describe_frame(MessageList<Messages...>, const Frame& frame) {
  std::string text;
  const auto look = [&]<class M>(M) {
    if (const auto message = read<M>(frame)) text = describe(*message);
  };
  (look(Messages{}), ...);
  return text;
}

}  // namespace

int main(int argc, char** argv) {
  const std::vector<std::string> words(argv + 1, argv + argc);
  if (words.size() == 2 && words[0] == "write") {
    write_all(AllMessages{}, words[1]);
    return 0;
  }
  if (words.size() != 2 || words[0] != "read") {
    return fmt::print(stderr, "usage: mavlink_samples write FOLDER | read FILE\n"), 2;
  }
  std::ifstream file(words[1], std::ios::binary);
  const std::vector<std::uint8_t> bytes(std::istreambuf_iterator<char>(file), {});
  FrameReader reader;
  std::vector<std::string> rows;
  reader.read(bytes,
              [&](const Frame& frame) { rows.push_back(describe_frame(AllMessages{}, frame)); });
  fmt::print("{}", joined(rows));
  const auto& losses = reader.losses();
  return losses.wrong_crc + losses.unknown + losses.bytes == 0 ? 0 : 1;
}
