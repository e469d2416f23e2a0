#include "cell/surrogate/surrogate_data.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <limits>

#include "cell/surrogate/cached_cell.h"

namespace microinjection {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

class StoredCell : public testing::Test {
 protected:
  void SetUp() override { cell_.save(scene_, cell_.range, path_); }
  void TearDown() override { std::filesystem::remove(path_); }

  CacheRead<SurrogateData> load() const { return SurrogateData::load(scene_, SurrogateRange::standard(scene_), path_); }

  const Scene scene_ = pipette();
  const SurrogateData cell_ = smallCell(scene_);
  const std::string path_ = testing::TempDir() + "microinjection_prepared.cell";
};

TEST_F(StoredCell, IsReadAsItWasWritten) {
  const CacheRead<SurrogateData> read = load();
  ASSERT_TRUE(read) << read.reason;
  EXPECT_NEAR(read.content->range.axis_depth, cell_.range.axis_depth, 1e-12 * cell_.range.axis_depth);
  EXPECT_EQ(read.content->energy.coefficients(), cell_.energy.coefficients());
  EXPECT_EQ(read.content->field.coefficients(), cell_.field.coefficients());
  Eigen::VectorXd rest[2], displaced[2];
  const Eigen::Vector3d u(1e-6, 0, -2e-6);
  cell_.surface.evaluate(0.2, u, rest[0], displaced[0]);
  read.content->surface.evaluate(0.2, u, rest[1], displaced[1]);
  EXPECT_TRUE(rest[0].isApprox(rest[1], 1e-12));
  EXPECT_TRUE(displaced[0].isApprox(displaced[1], 1e-6));  // of single precision
}

/// The part of the planned range that was reached.
TEST_F(StoredCell, KeepsASmallerRange) {
  SurrogateData shrunk = cell_;
  shrunk.range.depth *= 0.5;
  shrunk.range.lateral *= 0.4;
  shrunk.range.axis_depth *= 0.9;
  shrunk.save(scene_, cell_.range, path_);
  const CacheRead<SurrogateData> read = load();
  ASSERT_TRUE(read) << read.reason;
  EXPECT_NEAR(read.content->range.depth, shrunk.range.depth, 1e-9 * shrunk.range.depth);
  EXPECT_NEAR(read.content->range.lateral, shrunk.range.lateral, 1e-9 * shrunk.range.lateral);
  EXPECT_NEAR(read.content->range.axis_depth, shrunk.range.axis_depth, 1e-9 * shrunk.range.axis_depth);
}

/// A larger and softer cell of the same ratios has the same data, in its own units.
TEST_F(StoredCell, ServesASimilarScene) {
  Scene similar = scene_;
  constexpr double kLonger = 74.0 / 56, kStiffer = 15.0 / 17.9;
  similar.cell.layers.front().outer_radius *= kLonger;
  similar.cell.material().young_modulus *= kStiffer;
  similar.holding_pipette.contact_radius *= kLonger;
  similar.needle.tip.radius *= kLonger;
  const CacheRead<SurrogateData> own = load();
  const auto other = SurrogateData::load(similar, SurrogateRange::standard(similar), path_);
  ASSERT_TRUE(own && other) << own.reason << other.reason;
  const Eigen::Vector3d u(1e-6, 0.5e-6, -6e-6);
  const auto force = [](const SurrogateData& cell, const Eigen::Vector3d& displacement) {
    ForceField::Local local;
    cell.field.makeLocal(0.4, local);
    Eigen::Matrix3d jacobian;
    return local.evaluate(displacement, jacobian);
  };
  const Eigen::Vector3d expected = kStiffer * kLonger * kLonger * force(*own.content, u);
  EXPECT_GT(expected.norm(), 0);
  EXPECT_LT((force(*other.content, kLonger * u) - expected).norm(), 1e-9 * expected.norm());
  Eigen::VectorXd rest[2], displaced[2];
  own.content->surface.evaluate(0.2, u, rest[0], displaced[0]);
  other.content->surface.evaluate(0.2, kLonger * u, rest[1], displaced[1]);
  EXPECT_TRUE(rest[1].isApprox(kLonger * rest[0], 1e-9));
  EXPECT_TRUE(displaced[1].isApprox(kLonger * displaced[0], 1e-6));
  Scene thinner = similar;
  thinner.needle.tip.radius *= 0.99;
  EXPECT_EQ(SurrogateData::load(thinner, SurrogateRange::standard(thinner), path_).state, CacheState::kOther);
}

/// What no checksum can tell: a program that stored nonsense. A force that is no number must not reach a hand.
TEST_F(StoredCell, WhatCannotBeIsDamagedWhateverItsChecksum) {
  const std::size_t energy = 9 * sizeof(double) + 3 * sizeof(std::int32_t);  // its size, then its coefficients
  const std::size_t field = energy + sizeof(std::uint64_t) + sizeof(double) * cell_.energy.coefficients().size();
  const std::size_t surface = field + sizeof(std::uint64_t) + sizeof(double) * cell_.field.coefficients().size();
  const std::size_t radius = surface + 4 * sizeof(double), centres = radius + sizeof(double);
  const std::vector<std::pair<const char*, std::function<void(std::string&)>>> changes = {
      {"empty", [](std::string& body) { body.clear(); }},
      {"short", [](std::string& body) { body.pop_back(); }},
      {"long", [](std::string& body) { body += 'x'; }},
      {"depth", [](std::string& body) { overwrite(body, 0, kNan); }},
      {"deeper than was asked for", [](std::string& body) { overwrite(body, 0, 2.0); }},
      {"lateral range", [](std::string& body) { overwrite(body, 2 * sizeof(double), 0.0); }},
      {"scale", [](std::string& body) { overwrite(body, 3 * sizeof(double), 0.0); }},
      {"error", [](std::string& body) { overwrite(body, 7 * sizeof(double), kNan); }},
      {"degree", [](std::string& body) { overwrite<std::int32_t>(body, 9 * sizeof(double), -1); }},
      {"huge size", [=](std::string& body) { overwrite(body, energy, ~std::uint64_t{0}); }},
      {"energy", [=](std::string& body) { overwrite(body, energy + 2 * sizeof(double), kNan); }},
      {"force", [=](std::string& body) { overwrite(body, field + 2 * sizeof(double), kNan); }},
      {"surface's range", [=](std::string& body) { overwrite(body, surface, 0.0); }},
      {"radius", [=](std::string& body) { overwrite(body, radius, -1.0); }},
      {"rows of the centres", [=](std::string& body) { overwrite<std::int64_t>(body, centres, 3); }},
      {"centre", [=](std::string& body) { overwrite(body, centres + 2 * sizeof(std::int64_t), kNan); }},
      {"mode", [](std::string& body) { overwrite(body, body.size() - sizeof(double), kNan); }}};
  for (const auto& [what, change] : changes) {
    cell_.save(scene_, cell_.range, path_);
    changeBody(path_, change);
    const CacheRead<SurrogateData> read = load();
    EXPECT_FALSE(read) << what;
    EXPECT_EQ(read.state, CacheState::kDamaged) << what;
    EXPECT_EQ(read.reason.find(path_ + ": is damaged: "), 0u) << what << ": " << read.reason;
  }
}

TEST_F(StoredCell, OfAnotherVersionIsNotCalledDamaged) {
  writeCacheFile(path_, "surrogate cell 0", "body");
  EXPECT_EQ(load().state, CacheState::kOther);
}

}  // namespace
}  // namespace microinjection
