/// Requirements for every registered job, built in or from a plugin.

#include <gtest/gtest.h>

#include <cmath>
#include <regex>
#include <set>

#include "tests/worlds/mapping/jobs/job_fixture.h"

namespace vinerow::job_conformance_test {
namespace {

using test::job_parameters;
using test::ScratchFolder;

/// Parameters that make a job small, and those that it must be given.
ParameterSet small_parameters(const std::string& type) {
  ParameterSet parameters = job_parameters(type);
  if (type == "photogrammetry") parameters.set("density_per_m2", 150.0);
  if (type == "cloud_map") parameters.set("occupancy_cell_m", 0.1);
  if (type == "plan") parameters.set("vehicle", std::string("rover"));
  return parameters;
}

class JobConformance : public ::testing::TestWithParam<std::string> {
 protected:
  const PartSpec& spec() const { return test::all_parts().spec(PartKind::kJob, GetParam()); }
  /// What the job cannot do without, of the small vineyard.
  std::map<std::string, Product> inputs() const {
    std::map<std::string, Product> products;
    for (const ProductPort& port : spec().takes) {
      if (!port.required) continue;
      if (port.kind == ProductKind::kPictures) {
        products[port.key] = test::pictures_input(
            test::pictures_of(*test::surveyed_world("vineyard").model))["pictures"];
      } else if (port.kind == ProductKind::kCloud) {
        products[port.key] = test::make_cloud(folder_.path() / "input");
      } else {
        ADD_FAILURE() << "this suite has no product of kind " << to_string(port.kind);
      }
    }
    return products;
  }
  const ScratchFolder folder_{"job_conformance"};
};

TEST_P(JobConformance, SaysWhatItTakesAndGives) {
  EXPECT_FALSE(spec().description.empty());
  ASSERT_TRUE(spec().gives.has_value());
  const std::regex snake_case("[a-z][a-z0-9_]*");
  std::set<std::string> keys = {"type", "name", "after", "on_failure", "timeout_s"};
  for (const ParameterSpec& parameter : spec().parameters) {
    EXPECT_FALSE(parameter.description.empty()) << parameter.name;
    EXPECT_TRUE(keys.insert(parameter.name).second) << parameter.name << " is a key of phases";
  }
  for (const ProductPort& port : spec().takes) {
    EXPECT_TRUE(std::regex_match(port.key, snake_case)) << port.key;
    EXPECT_FALSE(port.description.empty()) << port.key;
    EXPECT_TRUE(keys.insert(port.key).second) << port.key << " is taken";
  }
}

TEST_P(JobConformance, GivesWhatItSaysTheSameTwice) {
  const auto input = inputs();
  std::vector<JobOutcome> outcomes;
  std::vector<std::map<std::string, std::string>> files;
  for (const char* name : {"first", "second"}) {
    const auto folder = folder_.path() / name;
    auto made = test::run_job(GetParam(), small_parameters(GetParam()), folder, input);
    ASSERT_TRUE(made) << made.reason();
    outcomes.push_back(std::move(made).value());
    files.push_back(test::files_in(folder));
    const Product& product = outcomes.back().product;
    EXPECT_EQ(product.kind, *spec().gives);
    if (product.kind == ProductKind::kCloud) {
      EXPECT_TRUE(std::filesystem::exists(product.file));
    }
    if (product.kind == ProductKind::kMap) {
      EXPECT_NE(product.map, nullptr);
    }
    if (product.kind == ProductKind::kPlan) {
      EXPECT_NE(product.plan, nullptr);
    }
    if (!product.file.empty()) {
      const auto inside = std::filesystem::relative(product.file, folder).string();
      EXPECT_NE(inside.substr(0, 2), "..") << "its files are in its own folder";
    }
  }
  EXPECT_EQ(outcomes[0].numbers, outcomes[1].numbers);
  EXPECT_EQ(outcomes[0].notes, outcomes[1].notes);
  for (const auto& [name, value] : outcomes[0].numbers) {
    EXPECT_TRUE(std::isfinite(value)) << name;
  }
  ASSERT_EQ(files[0].size(), files[1].size());
  for (const auto& [name, bytes] : files[0]) {
    EXPECT_TRUE(files[1].count(name) == 1 && files[1].at(name) == bytes) << name << " differs";
  }
}

INSTANTIATE_TEST_SUITE_P(Jobs, JobConformance,
                         ::testing::ValuesIn(test::all_parts().names(PartKind::kJob)),
                         [](const auto& job) { return job.param; });

}  // namespace
}  // namespace vinerow::job_conformance_test
