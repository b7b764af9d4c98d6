#include "engine/playback/frame_words.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <sstream>

namespace vinerow::playback {
namespace {

/// Number of characters that fill two thirds of the width of a 16:9 picture.
constexpr std::size_t kLongestTitle = 52;

std::string in_words(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

std::string capitalised(std::string text) {
  if (!text.empty()) {
    text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  }
  return text;
}

}  // namespace

std::string title_of_name(const std::string& name) {
  return capitalised(in_words(name));
}

std::string picture_title(const scenario::Scenario& scenario) {
  std::string title = scenario.description;
  for (const char* end : {". ", ": ", " - ", "\n"}) title = title.substr(0, title.find(end));
  while (!title.empty() && (title.back() == '.' || title.back() == ' ')) title.pop_back();
  if (title.empty() || title.size() > kLongestTitle) title = in_words(scenario.name);
  return capitalised(title);
}

std::string seen_text(const std::map<std::string, double>& shares) {
  std::string text;
  for (const auto& [vehicle, share] : shares) text += fmt::format("{} {:.5f}\n", vehicle, share);
  return text;
}

std::map<std::string, double> parse_seen(const std::string& text) {
  std::map<std::string, double> shares;
  std::istringstream lines(text);
  std::string vehicle;
  double share = 0.0;
  while (lines >> vehicle >> share) shares[vehicle] = share;
  return shares;
}

std::string clock_text(Time t) {
  // Truncated, because rounding 59.96 s would give 00:60.0.
  const std::int64_t tenths = t.ns / 100'000'000;
  return fmt::format("{:02d}:{:02d}.{}", tenths / 600, tenths / 10 % 60, tenths % 10);
}

std::vector<std::string> phases_at(const scenario::Scenario& scenario,
                                   const std::map<std::string, PhaseSpan>& spans, Time t) {
  std::vector<std::string> running;
  for (const scenario::PhaseConfig& phase : scenario.phases) {
    const auto span = spans.find(phase.name);
    if (span != spans.end() && span->second.contains(t)) running.push_back(in_words(phase.name));
  }
  return running;
}

}  // namespace vinerow::playback
