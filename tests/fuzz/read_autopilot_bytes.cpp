#include "tests/fuzz/read_autopilot_bytes.h"

#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "controllers/autopilot/ardupilot/servo_packet.h"
#include "controllers/autopilot/link/datagram_record.h"
#include "controllers/autopilot/mavlink/ground_station.h"
#include "controllers/autopilot/mavlink/parameter_file.h"
#include "engine/core/error.h"
#include "engine/mavlink/dialect.h"
#include "engine/mavlink/enums.h"

namespace vinerow::fuzz {
namespace {

using namespace controllers;
using Bytes = std::vector<std::uint8_t>;

[[noreturn]] void broken(const char* promise) {
  std::fprintf(stderr, "internal check failed: %s\n", promise);
  std::abort();
}

/// A sentence has words and one line.
void check_refusal(const std::string& refusal) {
  if (refusal.empty() || refusal.find('\n') != std::string::npos) broken("refused by a sentence");
}

void read_packet(std::span<const std::uint8_t> bytes, AutopilotTally& tally) {
  const auto packet = parse_servo_packet(bytes);
  if (!packet) {
    tally.refusal = packet.reason();
    return check_refusal(tally.refusal);
  }
  if (packet->channels != 16 && packet->channels != 32) broken("packets have 16 or 32 channels");
  ++tally.read;
}

/// A ground station with a mission and parameters, which a firmware of any manners answers.
void talk(const std::vector<Bytes>& pieces, AutopilotTally& tally) {
  mavlink::FrameReader of_station, of_firmware;
  GroundStationOptions options;
  options.parameters = {{"WP_SPEED", 1.0}};
  options.commands = {{0.5, 183, {1.0, 1500.0}}};
  options.expects_mission = true;
  GroundStation station(options, [&](std::span<const std::uint8_t> frame) {
    of_station.read(frame, [&](const mavlink::Frame&) { ++tally.sent; });
    if (of_station.losses().wrong_crc + of_station.losses().bytes > 0) broken("frames are whole");
  });
  station.fly(std::vector<mavlink::MissionItemInt>(3));
  Time now;
  for (const Bytes& piece : pieces) {
    now.ns += 300'000'000;
    of_firmware.read(piece, [&](const mavlink::Frame& frame) {
      ++tally.read;
      station.take(now, frame);
    });
    station.step(now);
  }
  tally.refusal = station.failure();
  if (!tally.refusal.empty()) check_refusal(tally.refusal);
  if (station.finished() && !tally.refusal.empty()) broken("finished or failed");
  for (const SpokenText& text : station.take_texts()) {
    for (const char c : text.text) {
      if (c < ' ' || c > '~') broken("texts are printable");
    }
  }
}

std::vector<Bytes> pieces_of(std::span<const std::uint8_t> bytes) {
  std::vector<Bytes> pieces;
  constexpr std::size_t kPiece = 37;
  for (std::size_t at = 0; at < bytes.size(); at += kPiece) {
    const auto piece = bytes.subspan(at, std::min(kPiece, bytes.size() - at));
    pieces.emplace_back(piece.begin(), piece.end());
  }
  return pieces;
}

Bytes frame_of(const mavlink::MessageLayout& layout, std::span<const std::uint8_t> payload) {
  Bytes frame{0xFD,
              static_cast<std::uint8_t>(payload.size()),
              0,
              0,
              0,
              1,
              1,
              static_cast<std::uint8_t>(layout.id),
              static_cast<std::uint8_t>(layout.id >> 8),
              static_cast<std::uint8_t>(layout.id >> 16)};
  frame.insert(frame.end(), payload.begin(), payload.end());
  mavlink::Crc16 crc;
  crc.add(std::span<const std::uint8_t>(frame).subspan(1));
  crc.add(layout.crc_extra);
  frame.push_back(static_cast<std::uint8_t>(crc.value()));
  frame.push_back(static_cast<std::uint8_t>(crc.value() >> 8));
  return frame;
}

std::vector<Bytes> messages_of(std::span<const std::uint8_t> bytes) {
  const auto known = mavlink::known_messages();
  std::vector<Bytes> messages;
  while (bytes.size() >= 2) {
    const mavlink::MessageLayout& layout = known[bytes[0] % known.size()];
    const std::size_t length = std::min<std::size_t>(bytes[1], bytes.size() - 2);
    messages.push_back(frame_of(layout, bytes.subspan(2, length)));
    bytes = bytes.subspan(2 + length);
  }
  return messages;
}

void read_parameters(std::span<const std::uint8_t> bytes, AutopilotTally& tally) {
  const std::string text(bytes.begin(), bytes.end());
  const auto parameters = parse_parameters(text, "x.parm");
  tally.read = static_cast<int>(parameters.size());
  // What we write, we read.
  if (parameter_text(parse_parameters(parameter_text(parameters), "x.parm")) !=
      parameter_text(parameters)) {
    broken("parameters come back");
  }
}

void read_recording(std::span<const std::uint8_t> bytes, AutopilotTally& tally) {
  const std::filesystem::path file =
      std::filesystem::temp_directory_path() / ("fuzz_" + std::to_string(::getpid()) + ".pcap");
  std::ofstream(file, std::ios::binary)
      .write(reinterpret_cast<const char*>(bytes.data()),
             static_cast<std::streamsize>(bytes.size()));
  try {
    DatagramReader reader(file, "rover.autopilot (replay)");
    while (reader.next()) ++tally.read;
  } catch (const ConfigError&) {
    std::filesystem::remove(file);
    throw;
  }
  std::filesystem::remove(file);
}

template <class M>
std::string message(const M& of) {
  mavlink::FrameWriter writer{mavlink::Sender{1, 1}};
  const auto frame = writer.write(of);
  const auto known = mavlink::known_messages();
  const auto at = std::find_if(known.begin(), known.end(),
                               [](const auto& layout) { return layout.id == M::kId; });
  const auto payload = frame.subspan(10, frame.size() - 12);
  std::string bytes{static_cast<char>(at - known.begin()), static_cast<char>(payload.size())};
  bytes.append(payload.begin(), payload.end());
  return bytes;
}

std::string input(AutopilotInput kind, const std::string& rest) {
  return std::string(1, static_cast<char>(kind)) + rest;
}

}  // namespace

std::vector<AutopilotSeed> autopilot_seeds() {
  std::string packet16("\x1A\x48\xB0\x04\x07\0\0\0", 8);
  for (int i = 0; i < 16; ++i) packet16 += std::string("\xDC\x05", 2);
  std::string packet32("\x81\x73\xB0\x04\x07\0\0\0", 8);
  for (int i = 0; i < 32; ++i) packet32 += std::string("\xDC\x05", 2);

  // A flight: ready, upload, mode, armed, started, done.
  mavlink::Heartbeat idle;
  idle.type = mavlink::kTypeGroundRover;
  idle.autopilot = mavlink::kAutopilotArdupilot;
  mavlink::Heartbeat in_auto = idle, armed = idle;
  in_auto.custom_mode = armed.custom_mode = 10;
  armed.base_mode = mavlink::kModeFlagArmed;
  mavlink::ParamValue parameter;
  mavlink::set_text(parameter.param_id, "WP_SPEED");
  parameter.param_value = 1.0F;
  mavlink::SysStatus ready;
  ready.onboard_control_sensors_health = mavlink::kSensorPrearmCheck;
  mavlink::MissionRequestInt request;
  request.seq = 2;
  mavlink::CommandAck started;
  started.command = mavlink::kCommandMissionStart;
  mavlink::MissionItemReached reached;
  reached.seq = 2;
  mavlink::StatusText text;
  text.severity = 2;
  mavlink::set_text(text.text, "PreArm: GPS 1: Bad fix");
  const std::string flight = message(idle) + message(text) + message(parameter) +
                             message(mavlink::Attitude{}) + message(mavlink::GpsGlobalOrigin{}) +
                             message(mavlink::LocalPositionNed{}) + message(ready) +
                             message(request) + message(mavlink::MissionAck{}) + message(in_auto) +
                             message(armed) + message(started) + message(reached) + message(idle);
  std::string stream;
  const std::span flight_bytes(reinterpret_cast<const std::uint8_t*>(flight.data()), flight.size());
  for (const Bytes& frame : messages_of(flight_bytes)) stream.append(frame.begin(), frame.end());

  const std::filesystem::path file = std::filesystem::temp_directory_path() /
                                     ("fuzz_seed_" + std::to_string(::getpid()) + ".pcap");
  {
    DatagramRecorder recorder(file);
    const mavlink::UdpAddress ours{0x7F000001, 9002}, theirs{0x7F000001, 0};
    const std::span packet(reinterpret_cast<const std::uint8_t*>(packet16.data()), packet16.size());
    recorder.add(Time{1'000'000}, theirs, ours, packet);
    recorder.add(Time{2'000'000}, ours, theirs, packet.first(9));
  }
  std::ifstream in(file, std::ios::binary);
  const std::string recording((std::istreambuf_iterator<char>(in)),
                              std::istreambuf_iterator<char>());
  std::filesystem::remove(file);

  return {{"packet_16", input(AutopilotInput::kServoPacket, packet16), 1},
          {"packet_32", input(AutopilotInput::kServoPacket, packet32), 1},
          {"stream", input(AutopilotInput::kMavlink, stream), 14},
          {"flight", input(AutopilotInput::kMessages, flight), 14},
          {"parameters",
           input(AutopilotInput::kParameters,
                 "# rover\nWP_SPEED 1.5\nCRUISE_SPEED,2\n1\t1\tRC1_MAX\t2000\t9\n"),
           3},
          {"recording", input(AutopilotInput::kRecording, recording), 2}};
}

AutopilotTally read_autopilot_bytes(std::span<const std::uint8_t> bytes) {
  AutopilotTally tally;
  if (bytes.empty()) return tally;
  constexpr int kKinds = 5;
  const auto kind = static_cast<AutopilotInput>(bytes[0] % kKinds);
  const auto rest = bytes.subspan(1);
  try {
    switch (kind) {
      case AutopilotInput::kServoPacket:
        read_packet(rest, tally);
        break;
      case AutopilotInput::kMavlink:
        talk(pieces_of(rest), tally);
        break;
      case AutopilotInput::kMessages:
        talk(messages_of(rest), tally);
        break;
      case AutopilotInput::kParameters:
        read_parameters(rest, tally);
        break;
      case AutopilotInput::kRecording:
        read_recording(rest, tally);
        break;
    }
  } catch (const ConfigError& error) {
    tally.refusal = error.what();
    check_refusal(tally.refusal);
  }
  return tally;
}

}  // namespace vinerow::fuzz
