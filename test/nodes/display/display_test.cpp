#include <geometry_msgs/PointStamped.h>
#include <gtest/gtest.h>
#include <tf2_msgs/TFMessage.h>
#include <visualization_msgs/MarkerArray.h>

#include <Eigen/Core>
#include <cmath>

#include "cell_microinjection/CellState.h"
#include "cell_microinjection/DisplayView.h"
#include "nodes/runtime/conversions.h"
#include "virtual_session.h"

namespace microinjection {
namespace {

/// What rviz is shown of a tilted needle and of a cell that the test describes.
class DisplayTest : public testing::Test {
 protected:
  static constexpr double kScale = 1e4, kYoung = 10e3, kRadius = 28e-6, kTilt = 0.4;  // 1, Pa, m, rad about y
  static constexpr double kStretch = 1.1;
  using Marker = visualization_msgs::Marker;

  DisplayTest() {
    TestNode& world = session_.addTestNode("tip", 0.05);
    geometry_msgs::TransformStamped frame;
    frame.header.stamp = session_.now();
    frame.header.frame_id = "world";
    frame.child_frame_id = "needle_tip";
    frame.transform.translation = toMessage<geometry_msgs::Vector3>(tip_);
    frame.transform.rotation.y = std::sin(kTilt / 2);
    frame.transform.rotation.w = std::cos(kTilt / 2);
    tf2_msgs::TFMessage frames;
    frames.transforms = {frame};
    world.say("/tf_static", frames, true);
    world.repeat("/force_sensor/measured_cf", wrenchMessage(0, 0, 2e-6, "needle_tip"));
    session_.world().hear<cell_microinjection::DisplayView>("/viz/view");
    session_.world().hear<visualization_msgs::MarkerArray>("/viz/markers");
    session_.world().hear<visualization_msgs::MarkerArray>("/viz/still");
    session_.world().hear<tf2_msgs::TFMessage>("/tf");
    session_.add("display");
    session_.run(0.5);
  }

  /// The newest marker of this name and number; null: there has been none.
  const Marker* marker(const std::string& name, int id = 0) {
    const Marker* newest = nullptr;
    for (const char* topic : {"/viz/markers", "/viz/still"}) {
      for (const auto& message : session_.world().hear<visualization_msgs::MarkerArray>(topic).all()) {
        for (const Marker& each : message->markers) {
          if (each.ns == name && each.id == id) newest = &each;
        }
      }
    }
    return newest;
  }
  bool isDrawn(const std::string& name, int id = 0) {
    const Marker* found = marker(name, id);
    return found && found->action == Marker::ADD;
  }
  static Eigen::MatrixX3d points(const Marker& marker) {
    Eigen::MatrixX3d places(marker.points.size(), 3);
    for (std::size_t i = 0; i < marker.points.size(); ++i)
      places.row(static_cast<Eigen::Index>(i)) = toVector(marker.points[i]);
    return places;
  }
  /// A number beside the colour scale.
  double label(int id) {
    const Marker* found = marker("legend_labels", id);
    return found ? std::stod(found->text) : NAN;
  }
  bool isTitled(const std::string& title) {
    for (int id = 0; id < 10; ++id) {
      if (isDrawn("legend_labels", id) && marker("legend_labels", id)->text == title) return true;
    }
    return false;
  }

  /// An octahedron that is that much larger than at rest: a shell of it is without pressure.
  static cell_microinjection::CellState stretched(double stretch, double young = kYoung) {
    cell_microinjection::CellState state;
    state.header.frame_id = "cell";
    const double corners[][3] = {{1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
    for (const auto& corner : corners) {
      const auto at = [&](double radius) {
        geometry_msgs::Point32 vertex;
        vertex.x = static_cast<float>(radius * corner[0]);
        vertex.y = static_cast<float>(radius * corner[1]);
        vertex.z = static_cast<float>(radius * corner[2]);
        return vertex;
      };
      state.rest_vertices.push_back(at(kRadius));
      state.vertices.push_back(at(stretch * kRadius));
      state.displacement.push_back(static_cast<float>((stretch - 1) * kRadius));
    }
    state.triangles = {0, 1, 4, 1, 2, 4, 2, 3, 4, 3, 0, 4, 1, 0, 5, 2, 1, 5, 3, 2, 5, 0, 3, 5};
    state.parameter_names = {"young_modulus", "poisson_ratio"};
    state.parameter_values = {young, 0.49};
    state.material = "neo_hookean";
    state.layer_radii = {kRadius, 24e-6};
    state.converged = 1;
    return state;
  }
  void showCell(const cell_microinjection::CellState& cell) {
    session_.world().sayNow("/cell/state", cell);
    session_.run(0.1);
  }
  void show(const std::string& colour, bool section, const std::string& title) {
    cell_microinjection::DisplayView view;
    view.colour = colour;
    view.section = section ? 1 : 0;
    session_.world().say("/viz/set_view", view);
    showCell(stretched(kStretch));
    EXPECT_TRUE(isTitled(title)) << title;
    const auto* shown = session_.world().hear<cell_microinjection::DisplayView>("/viz/view").newest();
    ASSERT_TRUE(shown);
    EXPECT_EQ(shown->colour, colour);
    EXPECT_EQ(shown->section != 0, section);
  }

  const Eigen::Vector3d tip_{5e-6, -3e-6, 40e-6};                    // m
  const Eigen::Vector3d axis_{std::sin(kTilt), 0, std::cos(kTilt)};  // of the pipette, world
  VirtualSession session_{{"hand.device:=none"}};
};

TEST_F(DisplayTest, NeedleIsShownAtItsPlaceAndTilted) {
  const geometry_msgs::TransformStamped* shown = nullptr;
  for (const auto& message : session_.world().hear<tf2_msgs::TFMessage>("/tf").all()) {
    for (const auto& frame : message->transforms) {
      if (frame.child_frame_id == "viz/needle_tip") shown = &frame;
    }
  }
  ASSERT_TRUE(shown);
  EXPECT_EQ(shown->header.frame_id, "viz/world");
  EXPECT_LT((toVector(shown->transform.translation) - kScale * tip_).norm(), 1e-9);
  const auto& rotation = shown->transform.rotation;
  const Eigen::Vector4d turn(rotation.x, rotation.y, rotation.z, rotation.w);
  EXPECT_LT((turn - Eigen::Vector4d(0, std::sin(kTilt / 2), 0, std::cos(kTilt / 2))).norm(), 1e-9);
  ASSERT_TRUE(isDrawn("injection_pipette"));
  EXPECT_EQ(marker("injection_pipette")->header.frame_id, "viz/needle_tip");
  const Eigen::VectorXd heights = points(*marker("injection_pipette")).col(2);
  EXPECT_NEAR(heights.minCoeff(), 0, 0.1);  // it reaches from the tip out of the cell
  EXPECT_GT(heights.maxCoeff(), 1);
}

TEST_F(DisplayTest, ColourIsThatOfTheStress) {
  show("von_mises_stress", false, "von Mises stress");
  // A sheet stretched by a in both directions, nearly incompressible: mu (a^2 - 1/a^4), in kPa.
  const double stress = kYoung / 3 * (std::pow(kStretch, 2) - std::pow(kStretch, -4)) / 1e3;
  EXPECT_EQ(label(0), 0);
  EXPECT_GT(label(4), 0.97 * stress);
  EXPECT_LT(label(4), 1.5 * stress);
  show("pressure", false, "pressure");
  EXPECT_LT(label(0), 0);
  // What there is not changes nothing.
  cell_microinjection::DisplayView wrong;
  wrong.colour = "temperature";
  session_.world().say("/viz/set_view", wrong);
  showCell(stretched(kStretch));
  EXPECT_TRUE(isTitled("pressure"));
  EXPECT_EQ(session_.world().hear<cell_microinjection::DisplayView>("/viz/view").newest()->colour, "pressure");
  show("displacement", false, "displacement");
}

/// What a material alone has is among the parameters of its message.
TEST_F(DisplayTest, ColourIsThatOfTheStressOfAnExponent) {
  show("von_mises_stress", false, "von Mises stress");
  cell_microinjection::CellState cell = stretched(kStretch);
  cell.material = "ogden";
  cell.parameter_names.emplace_back("ogden_exponent");
  cell.parameter_values.push_back(30);
  showCell(cell);
  // As above: 2 mu / 30 (a^30 - 1/a^60), in kPa, 2.2 times that of neo-Hookean.
  const double stress = kYoung / 45 * (std::pow(kStretch, 30) - std::pow(kStretch, -60)) / 1e3;
  EXPECT_GT(label(4), 0.97 * stress);
  EXPECT_LT(label(4), 1.5 * stress);
}

/// It grows while the cell is the same, so that a colour keeps its meaning.
TEST_F(DisplayTest, ScaleBeginsAnewWithAnotherCell) {
  show("displacement", false, "displacement");
  EXPECT_EQ(label(4), 3.2);  // um, above 2.8
  for (int i = 0; i < 20; ++i) showCell(stretched(1.05));
  EXPECT_EQ(label(4), 3.2);
  showCell(stretched(1.05, 2 * kYoung));
  EXPECT_EQ(label(4), 1.6);
}

TEST_F(DisplayTest, CellIsCutThroughThePipettesAxis) {
  show("displacement", true, "displacement");
  ASSERT_TRUE(isDrawn("section", 0));
  ASSERT_TRUE(isDrawn("section", 1)) << "the cut face of the second layer";
  const Eigen::MatrixX3d outer = points(*marker("section", 0)), inner = points(*marker("section", 1));
  EXPECT_NEAR(outer.cwiseAbs().maxCoeff(), kScale * kStretch * kRadius, 0.06);
  EXPECT_LT(inner.cwiseAbs().maxCoeff(), outer.cwiseAbs().maxCoeff() - 0.01);  // a border of a facetted cell
  // The plane contains the tip and the pipette's axis, and faces the viewer.
  EXPECT_NEAR(outer.col(1).minCoeff(), kScale * tip_.y(), 0.01);
  EXPECT_NEAR(outer.col(1).maxCoeff(), kScale * tip_.y(), 0.01);
  show("displacement", false, "displacement");
  EXPECT_FALSE(isDrawn("section", 0));
  EXPECT_FALSE(isDrawn("section", 1));
}

TEST_F(DisplayTest, ProposedPlaceIsACrossUntilItIsForgotten) {
  geometry_msgs::PointStamped place;
  place.header.frame_id = "world";
  place.point = toMessage<geometry_msgs::Point>(tip_);
  session_.world().sayNow("/visual_servo/proposed_point", place);
  session_.run(0.1);
  ASSERT_TRUE(isDrawn("proposed_place"));
  EXPECT_EQ(marker("proposed_place")->header.frame_id, "viz/world");
  const Eigen::RowVector3d centre = points(*marker("proposed_place")).colwise().mean();
  EXPECT_LT((centre.transpose() - kScale * tip_).norm(), 1e-9);
  session_.world().say("/visual_servo/proposed_point", place);  // with stamp 0
  session_.run(0.1);
  EXPECT_FALSE(isDrawn("proposed_place"));
  // What visual_servo does not repeat is forgotten, too.
  session_.world().sayNow("/visual_servo/proposed_point", place);
  session_.run(0.1);
  EXPECT_TRUE(isDrawn("proposed_place"));
  session_.run(1.1);
  EXPECT_FALSE(isDrawn("proposed_place"));
}

TEST_F(DisplayTest, ForceIsAnArrowAlongThePipetteBesideTheTip) {
  ASSERT_TRUE(isDrawn("measured_force"));
  const Marker& arrow = *marker("measured_force");
  EXPECT_EQ(arrow.header.frame_id, "viz/world");
  ASSERT_EQ(arrow.points.size(), 2u);
  const Eigen::Vector3d tail = toVector(arrow.points[0]), head = toVector(arrow.points[1]);
  EXPECT_LT(((head - tail).normalized() - axis_).norm(), 1e-6);
  const Eigen::Vector3d beside = tail - kScale * tip_;
  EXPECT_NEAR(beside.dot(axis_), kScale * 20e-6, 1e-6);
  EXPECT_NEAR((beside - beside.dot(axis_) * axis_).norm(), kScale * 16e-6, 1e-6);
}

}  // namespace
}  // namespace microinjection
