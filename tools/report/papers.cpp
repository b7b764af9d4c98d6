#include "tools/report/papers.h"

#include <fmt/format.h>

#include "tools/report/html.h"

namespace vinerow::tools::report {
namespace {

struct Paper {
  char letter;
  const char* authors;
  const char* title;
  const char* place;
};

constexpr Paper kPapers[] = {
    {'A', "M. Mammarella et al.",
     "Cooperation of unmanned systems for agricultural applications: A case study in a vineyard",
     "Biosystems Engineering 223, 2022"},
    {'B', "S. Martelli, F. Mocera, A. Somà",
     "Autonomous Driving Strategy for a Specialized Four-Wheel Differential-Drive Agricultural "
     "Rover",
     "AgriEngineering 6(3), 2024"},
    {'C', "C. Donati et al.",
     "3D Distance Filter for the Autonomous Navigation of UAVs in Agricultural Scenarios",
     "Remote Sensing 14(6), 2022"}};

std::string link_to(const Paper& paper) {
  return fmt::format("<a class=\"cite\" href=\"#paper-{0}\">[{0}]</a>", paper.letter);
}

}  // namespace

std::string with_citations(const std::string& html) {
  std::string out = html;
  for (const Paper& paper : kPapers) {
    const std::string name = fmt::format("paper {}", paper.letter), link = link_to(paper);
    for (std::size_t at = out.find(name); at != std::string::npos;
         at = out.find(name, at + link.size())) {
      out.replace(at, name.size(), link);
    }
  }
  return out;
}

std::string source_list(const std::string& page) {
  std::string entries;
  for (const Paper& paper : kPapers) {
    if (page.find(link_to(paper)) == std::string::npos) continue;
    entries += fmt::format(
        "<li id=\"paper-{0}\"><b>[{0}]</b> {1}: “{2}”, {3}. In files and "
        "messages: paper {0}.</li>\n",
        paper.letter, escaped(paper.authors), escaped(paper.title), escaped(paper.place));
  }
  return entries.empty() ? "" : "<ul class=\"sources\">\n" + entries + "</ul>\n";
}

}  // namespace vinerow::tools::report
