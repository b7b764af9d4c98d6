/// The page of all parts, and texts in it that a plug-in chose.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "engine/api/parameter_table.h"
#include "engine/core/error.h"
#include "tools/export/markdown.h"
#include "tools/vinerow/parts_page.h"

namespace vinerow::tools::list_markdown_test {
namespace {

using ::testing::HasSubstr;

struct Post {
  double x_m = 0.0;
};

struct Field {
  enum class Soil { kGrass, kMud };
  double size_m = 2.5;
  Soil soil = Soil::kGrass;
  std::array<double, 2> corner_m = {1.0, 2.0};
  std::optional<int> rows;
  std::vector<Post> posts;
};

std::vector<ParameterSpec> field_specs() {
  static const ParameterTable<Post> post =
      ParameterTable<Post>().number("x_m", "m", &Post::x_m, kAnyNumber, "east").required();
  return ParameterTable<Field>()
      .number("size_m", "m", &Field::size_m, kPositive, "edge|length of `it`")
      .choice("soil", &Field::soil, {{"grass", Field::Soil::kGrass}, {"mud", Field::Soil::kMud}},
              "under <wheels>")
      .numbers("corner_m", "m", &Field::corner_m, between(0.0, 5.0), "of the field")
      .integer("rows", &Field::rows, between(1, 9), "absent: none")
      .groups("posts", &Field::posts, post, "single_posts")
      .specs();
}

TEST(ListMarkdown, TellsEveryParameterInARow) {
  Registry registry;
  PartSpec spec;
  spec.name = "flat";
  spec.description = "a field";
  spec.parameters = field_specs();
  registry.add_world(spec, nullptr);
  EXPECT_EQ(part_markdown(registry, PartKind::kWorld, "flat"),
            "\n### world `flat`\n\na field\n\n"
            "| key | unit | default | values | meaning |\n|---|---|---|---|---|\n"
            "| `size_m` | m | `2.5` | > 0 | edge\\|length of \\`it\\` |\n"
            "| `soil` |  | `grass` | `grass`, `mud` | under \\<wheels> |\n"
            "| `corner_m` | m | `[1, 2]` | 2 numbers, 0 to 5 | of the field |\n"
            "| `rows` |  |  | whole, 1 to 9 | absent: none |\n"
            "| `posts` |  |  | list of mappings | single_posts |\n"
            "| `posts[].x_m` | m | required | number | east |\n");
}

TEST(ListMarkdown, TellsSignalsAndRate) {
  Registry registry;
  PartSpec spec;
  spec.name = "nose";
  spec.description = "smells";
  spec.default_rate_Hz = 5.0;
  spec.reads = {"truth"};
  registry.add_sensor(spec, nullptr);
  EXPECT_EQ(part_markdown(registry, PartKind::kSensor, "nose"),
            "\n### sensor `nose`\n\nsmells\n\n- default of `rate_Hz`: 5\n- reads: `truth`\n\n"
            "No parameters.\n");
}

TEST(ListMarkdown, KeepsTextsOfPlugInsInTheirCells) {
  EXPECT_EQ(markdown_code("a|b"), "`a\\|b`");
  EXPECT_EQ(markdown_code("a`b``c"), "``` a`b``c ```");
  EXPECT_EQ(markdown_code("<b>\n"), "`<b> `");
  EXPECT_EQ(markdown_code(""), "");
  EXPECT_EQ(markdown_text("size_m of *all*\n<b>[x](y)|\\`"),
            "size_m of \\*all\\* \\<b>\\[x\\](y)\\|\\\\\\`");
  EXPECT_EQ(markdown_text("_x_"), "\\_x\\_");
}

}  // namespace
}  // namespace vinerow::tools::list_markdown_test
