#include "cell/identification/force_curve.h"

#include <gtest/gtest.h>
#include <algorithm>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <string>

#include "base/errors.h"

namespace microinjection {
namespace {

class ForceCurveFile : public testing::Test {
 protected:
  ~ForceCurveFile() override { std::remove(path_.c_str()); }

  /// 100 rows down to 9.9 and 30 rows back; `row(i)` writes the position i in its own unit.
  template <typename Row>
  void write(const std::string& titles, const Row& row) {
    std::ofstream file(path_);
    file << "# a comment\n" << titles << '\n';
    for (int i = 0; i < 100; ++i) file << row(i) << '\n';
    for (int i = 99; i > 69; --i) file << row(i) << '\n';
  }

  std::string errorOf(const ForceCurveConfig& config = {}) {
    try {
      readForceCurve(path_, config);
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "";
  }

  const std::string path_ = testing::TempDir() + "microinjection_force_curve.csv";
};

bool hasNote(const ForceCurve& curve, const std::string& part) {
  return std::any_of(curve.notes.begin(), curve.notes.end(),
                     [&](const std::string& note) { return note.find(part) != std::string::npos; });
}

std::string text(double x) { return std::to_string(x); }

TEST_F(ForceCurveFile, ReadsTheRecordOfASession) {
  // The depth begins at the contact, and the predicted force is none that was measured.
  write("time_s,depth_m,predicted_axial_N,measured_axial_N,tip_z_m", [](int i) {
    return text(0.1 * i) + (i < 50 ? ",," : ",1e-6,") + "5," + text(2e-3 * i) + "," + text(1 - 1e-3 * i);
  });
  const ForceCurve curve = readForceCurve(path_, {});
  ASSERT_EQ(curve.size(), 100u);
  EXPECT_NEAR(curve.force[60], 0.12, 1e-9);
  EXPECT_NEAR(std::abs(curve.position[60] - curve.position[10]), 0.05, 1e-9);
}

TEST_F(ForceCurveFile, FindsNamesAndUnits) {
  write("Time (ms), Height [um], force_nN", [](int i) { return text(i) + ", " + text(0.1 * i) + "," + text(2.0 * i); });
  const ForceCurve curve = readForceCurve(path_, {});
  ASSERT_EQ(curve.size(), 100u);  // without the way back
  EXPECT_NEAR(curve.time[50], 0.05, 1e-12);
  EXPECT_NEAR(curve.position[50], 5e-6, 1e-15);
  EXPECT_NEAR(curve.force[50], 100e-9, 1e-18);
  EXPECT_TRUE(hasNote(curve, "column 'Height [um]' is taken for the tip's position"));
}

TEST_F(ForceCurveFile, KeepsTheWayBackWhenAsked) {
  write("t_s;z_m;f_N", [](int i) { return text(i) + ";" + text(i) + ";" + text(i); });
  ForceCurveConfig config;
  config.whole = true;
  EXPECT_EQ(readForceCurve(path_, config).size(), 130u);
}

TEST_F(ForceCurveFile, FindsBothSigns) {
  write("time_s,height_m,force_N", [](int i) { return text(i) + "," + text(-1.0 * i) + "," + text(-0.5 * i); });
  const ForceCurve curve = readForceCurve(path_, {});
  EXPECT_DOUBLE_EQ(curve.position[10], 10);
  EXPECT_DOUBLE_EQ(curve.force[10], 5);
}

TEST_F(ForceCurveFile, ASinglePositionFarOffIsNotTheDeepestOne) {
  for (const double far : {500.0, -500.0}) {
    write("time_s,height_m,force_N",
          [&](int i) { return text(i) + "," + text(i == 20 ? far : 1.0 * i) + "," + text(0.5 * i); });
    const ForceCurve curve = readForceCurve(path_, {});
    EXPECT_EQ(curve.size(), 100u) << testing::PrintToString(curve.notes);
    EXPECT_DOUBLE_EQ(curve.position[90], 90);
  }
}

TEST_F(ForceCurveFile, TakesTheDeflectionOff) {
  write("time_s,height_um,deflection_um,force_N",
        [](int i) { return text(i) + "," + text(2.0 * i) + "," + text(0.5 * i) + "," + text(i); });
  EXPECT_NEAR(readForceCurve(path_, {}).position[10], 15e-6, 1e-15);
}

TEST_F(ForceCurveFile, LeavesOutRowsWithoutNumbers) {
  write("time_s,height_m,force_N", [](int i) {
    return text(i) + "," + text(i) + "," + (i == 7 ? "nan" : i == 8 ? "" : i == 9 ? "x" : text(i));
  });
  const ForceCurve curve = readForceCurve(path_, {});
  EXPECT_EQ(curve.size(), 97u);
  EXPECT_TRUE(hasNote(curve, "3 rows without numbers"));
}

TEST_F(ForceCurveFile, NamesATextAmongNumbers) {
  write("time_s,height_m,force_N", [](int i) { return text(i) + "," + text(i) + "," + (i == 9 ? "off" : text(i)); });
  EXPECT_TRUE(hasNote(readForceCurve(path_, {}), "1 rows without numbers are left out, as that with 'off' in line 12"));
  write("time_s,height_m,force_N", [](int i) { return "soon," + text(i) + "," + text(i); });
  EXPECT_TRUE(hasNote(readForceCurve(path_, {}), "the time, has no numbers, but 'soon', and is left out"));
}

TEST_F(ForceCurveFile, ABaseNeedsADeflection) {
  write("time_s,position_m,force_N", [](int i) { return text(i) + "," + text(3.0 * i) + "," + text(i); });
  ForceCurveConfig config;
  config.position_of = "base";
  EXPECT_NE(errorOf(config).find("needs a column of the deflection, or --spring-constant"), std::string::npos);
  config.spring_constant = 1;
  EXPECT_NEAR(readForceCurve(path_, config).position[10], 20, 1e-9);
}

TEST_F(ForceCurveFile, TakesTheSegmentThatIsNamed) {
  for (const char* word : {"Extend", "1"}) {
    int row = 0;
    write("time_s,height_m,force_N,segment",
          [&](int i) { return text(i) + "," + text(i) + "," + text(i) + "," + (row++ < 100 ? word : "2"); });
    ForceCurveConfig config;
    config.segment = word;
    EXPECT_EQ(readForceCurve(path_, config).size(), 100u) << word;
    config.segment = "3";
    EXPECT_NE(errorOf(config).find("has no such text, but "), std::string::npos) << errorOf(config);
  }
}

TEST_F(ForceCurveFile, TakesColumnsByNameOrNumber) {
  write("a,b,c", [](int i) { return text(i) + "," + text(3.0 * i) + "," + text(i); });
  ForceCurveConfig config;
  config.columns = {{"position", "b:nm"}, {"force", "3:pN"}};
  const ForceCurve curve = readForceCurve(path_, config);
  EXPECT_FALSE(curve.timed);
  EXPECT_NEAR(curve.position[10], 30e-9, 1e-18);
  EXPECT_NEAR(curve.force[10], 10e-12, 1e-21);
}

TEST_F(ForceCurveFile, NamesWhatIsWrong) {
  write("time_s,height,force_N", [](int i) { return text(i) + "," + text(i) + "," + text(i); });
  EXPECT_NE(errorOf().find("column 'height': has no unit; give --column position=height:UNIT"), std::string::npos)
      << errorOf();
  write("time_s,height_inch,force_N", [](int i) { return text(i) + "," + text(i) + "," + text(i); });
  EXPECT_NE(errorOf().find("unit 'inch': must be one of m, mm, nm, um"), std::string::npos) << errorOf();
  write("time_s,height_m", [](int i) { return text(i) + "," + text(i); });
  EXPECT_NE(errorOf().find("has no column of the force"), std::string::npos) << errorOf();
  ForceCurveConfig config;
  config.columns = {{"farce", "a:N"}};
  EXPECT_NE(errorOf(config).find("--column farce: must be one of time, position, deflection, force"),
            std::string::npos);
  config.columns = {{"force", "a:N"}};
  EXPECT_NE(errorOf(config).find("the file has no column 'a'"), std::string::npos);
  std::ofstream(path_) << "time_s,height_m,force_N\n1,2,3\n";
  EXPECT_NE(errorOf().find("1 rows have a number in each column that is used, 0 have not: must be at least 20"),
            std::string::npos)
      << errorOf();
  std::remove(path_.c_str());
  EXPECT_NE(errorOf().find("cannot be read"), std::string::npos);
}

TEST(ForceCurve, AveragesNeighbours) {
  ForceCurve curve;
  for (int i = 0; i < 10; ++i) {
    for (std::vector<double>* values : {&curve.time, &curve.position, &curve.force}) values->push_back(i);
  }
  const ForceCurve means = averaged(curve, 4);
  ASSERT_EQ(means.size(), 3u);
  EXPECT_DOUBLE_EQ(means.force[1], 4);
  EXPECT_EQ(averaged(curve, 10).size(), 10u);
}

}  // namespace
}  // namespace microinjection
