#include <gtest/gtest.h>

#include <cmath>

#include "engine/core/error.h"
#include "engine/io/files/yaml.h"

namespace vinerow::scenario::scenario_yaml_test {
namespace {

template <class T>
T scalar(const std::string& text) {
  return std::get<T>(io::scalar_value(io::parse_yaml(text, "text", "/")));
}

TEST(Yaml, ScalarsFollowTheCoreSchema) {
  EXPECT_EQ(scalar<std::int64_t>("12"), 12);
  EXPECT_EQ(scalar<std::int64_t>("-12"), -12);
  EXPECT_EQ(scalar<std::int64_t>("+12"), 12);
  EXPECT_EQ(scalar<std::int64_t>("010"), 10);
  EXPECT_EQ(scalar<std::int64_t>("0x1F"), 31);
  EXPECT_EQ(scalar<std::int64_t>("0o17"), 15);
  EXPECT_EQ(scalar<std::int64_t>("9223372036854775807"), 9223372036854775807);
  EXPECT_EQ(scalar<double>("9223372036854775808"), 9223372036854775808.0);
  EXPECT_EQ(scalar<double>("1.5"), 1.5);
  EXPECT_EQ(scalar<double>(".5"), 0.5);
  EXPECT_EQ(scalar<double>("5."), 5.0);
  EXPECT_EQ(scalar<double>("-1e-3"), -0.001);
  EXPECT_EQ(scalar<double>("1e999"), HUGE_VAL);
  EXPECT_EQ(scalar<double>("-1e999"), -HUGE_VAL);
  EXPECT_EQ(scalar<double>("1e-999"), 0.0);
  EXPECT_EQ(scalar<double>("-.inf"), -HUGE_VAL);
  EXPECT_TRUE(std::isnan(scalar<double>(".nan")));
  EXPECT_EQ(scalar<bool>("true"), true);
  EXPECT_EQ(scalar<bool>("False"), false);
  for (const char* text : {"yes", "on", "1 m", "1.2.3", "e5", "1e", "0x", "0xg", ".", "1_000"}) {
    EXPECT_EQ(scalar<std::string>(text), text);
  }
  EXPECT_EQ(scalar<std::string>("'12'"), "12");
  EXPECT_EQ(scalar<std::string>("!!str 12"), "12");
}

TEST(Yaml, MarksAreLinesFromOne) {
  const io::YamlNode root = io::parse_yaml("a: 1\nb:\n  - x\n  - {c: 2}\n", "f.yaml", "/");
  EXPECT_EQ(root.mark.text(), "f.yaml:1");
  EXPECT_EQ(root.find_entry("b")->mark.line, 2);
  EXPECT_EQ(root.find("b")->items[1].find("c")->mark.line, 4);
}

TEST(Yaml, AliasesAreCopies) {
  const io::YamlNode root = io::parse_yaml("a: &x {b: [1, 2]}\nc: *x\n", "f.yaml", "/");
  EXPECT_EQ(root.find("c")->find("b")->items.size(), 2u);
}

std::string fault_of(const std::string& text) {
  try {
    io::parse_yaml(text, "f.yaml", "/");
    return "";
  } catch (const ConfigError& fault) {
    return fault.what();
  }
}

TEST(Yaml, AliasesThatExplodeOrCircleAreRefused) {
  EXPECT_EQ(fault_of("a: &x [*x]\n"), "f.yaml:1: an alias is inside the value that it refers to");
  std::string bomb = "a0: &a0 [1, 1, 1, 1, 1, 1, 1, 1, 1, 1]\n";
  for (int i = 1; i < 9; ++i) {
    const std::string last = "*a" + std::to_string(i - 1);
    bomb += "a" + std::to_string(i) + ": &a" + std::to_string(i) + " [" + last;
    for (int k = 0; k < 9; ++k) bomb += ", " + last;
    bomb += "]\n";
  }
  EXPECT_EQ(fault_of(bomb), "f.yaml:6: the file holds more than 200000 values");
}

TEST(Yaml, DeepNestingIsAnErrorNotACrash) {
  EXPECT_NE(fault_of(std::string(100'000, '[')), "");
  std::string deep;
  for (int i = 0; i < 3000; ++i) deep += std::string(static_cast<std::size_t>(i), ' ') + "a:\n";
  EXPECT_NE(fault_of(deep), "");
}

TEST(Yaml, TextsPrintAndReadBack) {
  io::YamlNode list = io::yaml_list();
  const std::vector<std::string> texts = {
      "",     " x",   "true",        "No",   "null", "~",    "12",  "1e5",
      "a: b", "#c",   "'",           "\"",   "\\",   "a\nb", "\t",  "[x]",
      "a,b",  "\x01", "caf\xc3\xa9", "/a/b", "-x",   "y",    "nan", ".nan"};
  for (const std::string& text : texts) list.items.push_back(io::yaml_text(text));
  const io::YamlNode back = io::parse_yaml(io::to_yaml(list), "text", "/");
  ASSERT_EQ(back.items.size(), texts.size());
  for (std::size_t i = 0; i < texts.size(); ++i) {
    EXPECT_EQ(std::get<std::string>(io::scalar_value(back.items[i])), texts[i]);
  }
}

}  // namespace
}  // namespace vinerow::scenario::scenario_yaml_test
