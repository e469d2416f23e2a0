#include "cell/family/family_reference.h"

#include <gtest/gtest.h>

#include <cstdio>
#include <fstream>
#include <string>

#include "base/errors.h"
#include "cell/family/made_up_family.h"

namespace microinjection {
namespace {

class References : public testing::Test {
 protected:
  References() {
    for (int member = 0; member < 2; ++member) {
      ReferencePlace place;
      place.member = member;
      place.coordinates = Eigen::Vector3d(0.125, -0.5, 0.001 * member);
      place.angle = 0.3 + member;
      place.displacement << 0.01, 1e-17, -0.25;
      place.force << 0.0012345678, -3e-9, 0.05;
      place.surface = Eigen::VectorXf::LinSpaced(3 * static_cast<Eigen::Index>(referenceNodes().size()), -0.1F, 0.1F);
      places_.push_back(place);
    }
  }
  ~References() override { std::remove(path_.c_str()); }

  void write(const std::string& text) { std::ofstream(path_) << text; }

  std::string errorOf(const std::string& text, int seed = 1) {
    write(text);
    try {
      readReferences(family_, seed, path_);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "";
  }

  const Family family_ = homogeneous();
  const std::string path_ = testing::TempDir() + "references.csv";
  std::vector<ReferencePlace> places_;
};

TEST_F(References, AreReadAsTheyWereWritten) {
  write(writeReferences(family_, 1, places_));
  const std::vector<ReferencePlace> read = readReferences(family_, 1, path_);
  ASSERT_EQ(read.size(), 2u);
  for (int i = 0; i < 2; ++i) {
    EXPECT_EQ(read[i].member, i);
    EXPECT_EQ(read[i].coordinates, places_[i].coordinates);
    EXPECT_EQ(read[i].angle, places_[i].angle);
    EXPECT_EQ(read[i].displacement, places_[i].displacement);
    EXPECT_LT((read[i].force - places_[i].force).norm(), 1e-9 * places_[i].force.norm());
    EXPECT_LT((read[i].surface - places_[i].surface).cwiseAbs().maxCoeff(), 1e-3);
  }
}

TEST_F(References, AMissingFileHasNone) { EXPECT_TRUE(readReferences(family_, 1, path_ + ".none").empty()); }

TEST_F(References, OfAnotherDrawAreRefused) {
  EXPECT_NE(errorOf(writeReferences(family_, 1, places_), 2).find("line 1"), std::string::npos);
}

TEST_F(References, ATornLineIsNamed) {
  const std::string text = writeReferences(family_, 1, places_);
  EXPECT_EQ(errorOf(text), "");
  EXPECT_NE(errorOf(text.substr(0, text.size() - 40)).find("line 4"), std::string::npos);
  EXPECT_NE(errorOf(text + "1,nonsense\n").find("'nonsense': must be a number"), std::string::npos);
}

}  // namespace
}  // namespace microinjection
