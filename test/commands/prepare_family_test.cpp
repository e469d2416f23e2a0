// Rounds of a family whose members and forces on the axis are made up: nothing is solved.

#include <string>

#include "base/bytes.h"
#include "base/cache_file.h"
#include "cell/family/axis_force.h"
#include "cell/family/made_up_family.h"
#include "commands/command_test.h"

namespace microinjection {
namespace {

namespace fs = std::filesystem;

/// With data of 18 members, of which errors were measured, and a cache of its own.
class PrepareFamily : public CommandTest {
 protected:
  PrepareFamily() : CommandTest(MICROINJECTION_PREPARE, "prepare_family") {}

  void SetUp() override {
    CommandTest::SetUp();
    setenv("XDG_CACHE_HOME", directory_.c_str(), 1);
    fs::copy_file(MICROINJECTION_SOURCE_DIR "/config/families/homogeneous.yaml", directory_ + "family.yaml");
    const FamilyData springs = familyOfSprings();
    FamilyData data(homogeneous());
    for (FamilyMember member : springs.members()) {
      member.field.setZero();  // but for a force on the axis in proportion to the depth
      member.field[member.field.size() - EnergyExpansion(EnergyScales(), {4, 4, 7, 1}).size()] = 1;
      data.add(member, MadeUp(member.coordinates).surface);
    }
    data.update();
    data.setMeasuredError({0.004, 0.015}, {Eigen::Vector3d(0.3, 0.2, -0.4)});
    data.save(data_);
    before_ = read(data_);
  }
  void TearDown() override {
    unsetenv("XDG_CACHE_HOME");
    CommandTest::TearDown();
  }

  /// Lays the axis' nodes into the cache, as their tasks would.
  static void storeAxis(bool solved) {
    const std::string family = homogeneous().description();
    const std::string folder = cacheDirectory("surrogates") + "/" + contentHash(family + " axis");
    fs::create_directories(folder);
    for (int node = 0; node < axisForceGrid(homogeneous()).size(); ++node) {
      ByteWriter writer;
      writer.array(solved ? Eigen::VectorXd(Eigen::VectorXd::LinSpaced(kAxisDepths, 0.1, 1)) : Eigen::VectorXd());
      const std::string number = std::to_string(node);
      writeCacheFile(folder + "/axis_" + number, family + " axis curve " + number, writer.bytes());
    }
  }

  /// The data after a call that starts from those before.
  std::string dataAfter(const std::string& arguments) const {
    std::ofstream(data_, std::ios::binary) << before_;
    const Outcome outcome = run("--family family.yaml " + arguments);
    EXPECT_EQ(outcome.status, 0) << arguments << ": " << outcome.err;
    return read(data_);
  }

  const std::string data_ = directory_ + "family.data";
  std::string before_;
};

TEST_F(PrepareFamily, ARoundThatAddsNothingLeavesTheDataAsTheyAre) {
  ASSERT_EQ(run("--family family.yaml --members 18 --list plan.csv").status, 0);
  storeAxis(false);
  const Outcome gathered = run("--family family.yaml --plan plan.csv --gather");
  EXPECT_EQ(gathered.status, 0) << gathered.err;
  EXPECT_NE(gathered.out.find("some members have no solution on the axis"), std::string::npos) << gathered.out;
  EXPECT_TRUE(read(data_) == before_) << "with their measured errors";
  EXPECT_TRUE(dataAfter("--members 18") == before_);
  EXPECT_TRUE(dataAfter("--members 18 --refit") == before_) << "no paths are known";
}

TEST_F(PrepareFamily, EachWayToTheSameMembersMakesTheSameBytes) {
  ASSERT_EQ(run("--family family.yaml --members 18 --list plan.csv").status, 0);
  const std::string plan = read(directory_ + "plan.csv");
  EXPECT_EQ(plan.rfind("# a round of prepare --family homogeneous --members 18, checksum ", 0), 0u) << plan;
  storeAxis(true);
  const std::string gathered = dataAfter("--plan plan.csv --gather");
  const auto data = FamilyData::load(homogeneous(), data_);
  ASSERT_TRUE(data) << data.reason;
  EXPECT_TRUE(data.content->hasAxisCurves());
  EXPECT_EQ(data.content->measuredError().members, 0) << "they were of other data";
  EXPECT_NE(data.content->provenance().find("--members 18\n"), std::string::npos) << data.content->provenance();
  EXPECT_TRUE(dataAfter("--members 18 --plan plan.csv --gather") == gathered);
  EXPECT_TRUE(dataAfter("--members 18") == gathered);

  const Outcome other = run("--family family.yaml --members 5 --plan plan.csv --gather");
  EXPECT_EQ(other.status, 2);
  EXPECT_NE(other.err.find("--members = 5: must be 18, as of plan.csv, or left out"), std::string::npos) << other.err;
  std::string changed = plan;
  std::ofstream(directory_ + "plan.csv") << changed.replace(changed.find("18"), 2, "19");
  EXPECT_NE(run("--family family.yaml --plan plan.csv --gather").err.find("is damaged"), std::string::npos);
}

TEST_F(PrepareFamily, OptionsThatDoNotBelongTogetherAreRefused) {
  const auto refuses = [&](const std::string& arguments, const std::string& message) {
    const Outcome outcome = run("--family family.yaml " + arguments);
    EXPECT_EQ(outcome.status, 2) << arguments;
    EXPECT_NE(outcome.err.find(message), std::string::npos) << arguments << ": " << outcome.err;
    EXPECT_FALSE(fs::exists(directory_ + "new.csv")) << arguments;
  };
  refuses("--task 0", "--task needs --plan");
  refuses("--gather", "--gather needs --plan");
  refuses("--gather --task 0", "--task and --gather: only one may be given");
  refuses("--plan plan.csv --gather --task 0", "--task and --gather: only one may be given");
  refuses("--plan plan.csv", "--plan needs one of --task and --gather");
  refuses("--list new.csv --plan plan.csv --gather", "--list and --plan: only one may be given");
  refuses("--list new.csv --gather", "--gather needs --plan");
}

}  // namespace
}  // namespace microinjection
