// The command as the demo runs it.

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

namespace {

namespace fs = std::filesystem;

constexpr char kHeader[] = "time_s,predicted_axial_N,in_contact,tip_x_m,tip_y_m,tip_z_m\n";

class TrajectoryErrorCommand : public testing::Test {
 protected:
  void SetUp() override {
    fs::remove_all(directory_);
    fs::create_directories(directory_);
    std::ofstream(directory_ + "scene.yaml")
        << "cell: {diameter: 56e-6, material: {model: linear, young_modulus: 17.9e3, poisson_ratio: 0.49}}\n"
           "holding_pipette: {contact_radius: 10e-6}\nneedle: {tip: {shape: disc, radius: 3e-6}}\n";
  }
  void TearDown() override { fs::remove_all(directory_); }

  int run(const std::string& session, const std::string& more = "") {
    std::ofstream(directory_ + "session.csv") << session;
    const std::string command = "cd " + directory_ +
                                " && " MICROINJECTION_TRAJECTORY_ERROR " --scene scene.yaml --session session.csv " +
                                more + " >out.txt 2>err.txt";
    const int status = std::system(command.c_str());
    for (auto [name, text] : {std::pair{"out.txt", &out_}, std::pair{"err.txt", &error_}}) {
      std::ostringstream stream;
      stream << std::ifstream(directory_ + name).rdbuf();
      *text = stream.str();
    }
    return WEXITSTATUS(status);
  }

  std::string directory_ = fs::temp_directory_path().string() + "/trajectory_error_test/", out_, error_;
};

/// test/reference/linear.csv: 0.1169 uN at 1 um. A session that says a tenth more is a tenth off, all the way; the
/// short contact before, and what is done on the way out, do not count.
TEST_F(TrajectoryErrorCommand, ComparesTheWayIn) {
  std::ostringstream session;
  session << kHeader << "0,0,0,0,0,29e-6\n1,9,1,0,0,27.9e-6\n2,0,0,0,0,29e-6\n";
  for (int i = 0; i <= 10; ++i) {
    session << 3 + i << ',' << 1.1 * 0.1169e-6 * 0.1 * i << ",1,0,0," << 28e-6 - 0.1e-6 * i << '\n';
  }
  session << "20,9,1,0,0,27.5e-6\n21,0,0,0,0,29e-6\n";
  ASSERT_EQ(run(session.str(), "--points 2 --csv table.csv"), 0) << error_;
  std::ifstream table(directory_ + "table.csv");
  std::string line;
  std::getline(table, line);
  EXPECT_EQ(line, "depth_m,session_N,full_N,error");
  for (const double depth : {0.5e-6, 1e-6}) {
    double found = 0, session_force = 0, full = 0, error = 0;
    char comma;
    ASSERT_TRUE(table >> found >> comma >> session_force >> comma >> full >> comma >> error);
    EXPECT_NEAR(found, depth, 1e-9);
    EXPECT_NEAR(error, 0.1, 0.03);  // the mesh's own error: 1 to 2 %
  }
  EXPECT_NE(out_.find("median"), std::string::npos);
}

/// The cell says some rows late that a layer gave way; what it gives force to from then on is not compared.
TEST_F(TrajectoryErrorCommand, TheWayInEndsAtThePuncture) {
  std::ostringstream session;
  session << "time_s,predicted_axial_N,in_contact,punctured,tip_x_m,tip_y_m,tip_z_m\n";
  for (int i = 0; i <= 10; ++i) {
    session << i << ',' << 0.1169e-6 * 0.1 * i << ",1,0,0,0," << 28e-6 - 0.1e-6 * i << '\n';
  }
  session << "11,0.02e-6,1,0,0,0,26.9e-6\n12,0.02e-6,1,1,0,0,26.8e-6\n13,9,1,1,0,0,24e-6\n14,0,0,1,0,0,29e-6\n";
  for (int i = 0; i <= 10; ++i) session << 15 + i << ",9,1,1,0,0," << 28e-6 - i * 1e-6 << '\n';
  ASSERT_EQ(run(session.str(), "--points 1 --csv table.csv"), 0) << error_;
  std::ifstream table(directory_ + "table.csv");
  std::string line;
  std::getline(table, line);
  double found = 0, session_force = 0;
  char comma;
  ASSERT_TRUE(table >> found >> comma >> session_force);
  EXPECT_NEAR(found, 1e-6, 1e-12);
  EXPECT_NEAR(session_force, 0.1169e-6, 1e-12);
}

TEST_F(TrajectoryErrorCommand, OutputThatCannotBeWrittenIsAnError) {
  std::ostringstream session;
  session << kHeader;
  for (int i = 0; i <= 10; ++i) session << i << ",1e-8,1,0,0," << 28e-6 - 0.1e-6 * i << '\n';
  EXPECT_EQ(run(session.str(), "--points 1 --csv /dev/full"), 2);
  EXPECT_NE(error_.find("/dev/full: cannot be written: No space left"), std::string::npos) << error_;
  EXPECT_EQ(run(session.str(), ">/dev/full 2>err.txt #"), 2);
  EXPECT_NE(error_.find("the standard output: cannot be written: No space left"), std::string::npos) << error_;
}

TEST_F(TrajectoryErrorCommand, RefusesWhatIsNoSession) {
  EXPECT_EQ(run("time_s,depth_m\n0,0\n"), 2);
  EXPECT_NE(error_.find("tip_x_m"), std::string::npos);
  EXPECT_EQ(run(std::string(kHeader) + "0,0,0,0,0,29e-6\n"), 2);
  EXPECT_NE(error_.find("never went into the cell"), std::string::npos);
  EXPECT_EQ(run(std::string(kHeader) + "0,oops,1,0,0,27e-6\n1,0,1,0,0,26e-6\n"), 2);
  EXPECT_NE(error_.find("oops"), std::string::npos);
  EXPECT_EQ(run(kHeader, "--points 0"), 2);
  EXPECT_EQ(run(kHeader, "--nonsense"), 2);
}

}  // namespace
