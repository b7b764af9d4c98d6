#include "tests/tools/study_plots/svg_reader.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace vinerow::study::svg_reader_test {
namespace {

using ::testing::HasSubstr;
using testing::overlaps;
using testing::read_xml;

TEST(StudySvgReader, ReadsElementsWithTheirAttributes) {
  const auto document = read_xml("<g class=\"a b\"><text x=\"1.5\">one &amp; two</text><p/></g>\n");
  EXPECT_EQ(document.fault, "");
  ASSERT_EQ(document.elements.size(), 3u);
  EXPECT_TRUE(document.elements[0].is("b"));
  EXPECT_FALSE(document.elements[0].is("c"));
  EXPECT_EQ(document.elements[1].number("x"), 1.5);
  EXPECT_EQ(document.elements[1].text, "one &amp; two");
}

TEST(StudySvgReader, FindsWhatIsNotWellFormed) {
  for (const char* bad :
       {"<a>", "<a></b>", "</a>", "<a b=1/>", "<a b=\"1\" b=\"2\"/>", "<a b=\"<\"/>", "<a>&</a>",
        "<a>&nbsp;</a>", "<a>\x01</a>", "<a>\xff</a>", "text", "<a b=\"1\"c=\"2\"/>", "<a"}) {
    EXPECT_NE(read_xml(bad).fault, "") << bad;
  }
}

TEST(StudySvgReader, FindsTextsThatOverlap) {
  const auto svg = [](const std::string& texts) {
    return read_xml("<svg viewBox=\"0 0 200 100\">" + texts + "</svg>");
  };
  EXPECT_EQ(overlaps(svg("<text x=\"10\" y=\"50\">abc</text><text x=\"60\" y=\"50\">abc</text>")),
            "");
  EXPECT_THAT(
      overlaps(svg("<text x=\"10\" y=\"50\">abcdef</text><text x=\"30\" y=\"55\">abc</text>")),
      HasSubstr("abc overlaps abcdef"));
  EXPECT_THAT(overlaps(svg("<text x=\"5\" y=\"50\" class=\"end\">abcdef</text>")),
              HasSubstr("beyond the picture: abcdef"));
}

}  // namespace
}  // namespace vinerow::study::svg_reader_test
