#include "benchmark/peers/peer_case.h"

#include <gtest/gtest.h>

#include <sstream>
#include <stdexcept>
#include <string>

#include "benchmark/peers/peer_result.h"

namespace microinjection {
namespace {

/// A tetrahedron of which one node is held and one glued.
PeerCase tetrahedron() {
  PeerCase result;
  result.scene = "cell.yaml";
  result.layers = {{"neo_hookean", 17.9e3, 0.49}};
  result.vertices = 4;
  result.nodes = {{0, 0, 0}, {1e-6, 0, 0}, {0, 1e-6, 0}, {0, 0, 1.0 / 3e6}};
  result.elements = {{0, {0, 1, 2, 3}}};
  result.surface = {{0, 2, 1}, {0, 1, 3}};
  result.held = {0};
  result.glued = {3};
  result.tip = {"disc", "sticking", 3e-6, 28e-6};
  result.motion = {{0, 0, -1e-7}, {1e-8, 0, -2e-7}};
  return result;
}

PeerCase read(const std::string& text) {
  std::istringstream stream(text);
  return readPeerCase(stream);
}

/// The text with one piece replaced.
std::string with(std::string text, const std::string& piece, const std::string& other) {
  const std::size_t at = text.find(piece);
  EXPECT_NE(at, std::string::npos) << piece;
  return text.replace(at, piece.size(), other);
}

TEST(PeerCase, ReadsWhatItWrites) {
  const PeerCase written = tetrahedron(), found = read(peerCaseText(written));
  EXPECT_EQ(found.scene, written.scene);
  EXPECT_EQ(found.nodes, written.nodes);  // every bit
  EXPECT_EQ(found.motion, written.motion);
  ASSERT_EQ(found.elements.size(), 1u);
  EXPECT_EQ(found.elements[0].nodes, written.elements[0].nodes);
  EXPECT_EQ(found.surface, written.surface);
  EXPECT_EQ(found.held, written.held);
  EXPECT_EQ(found.glued, written.glued);
  EXPECT_EQ(found.tip.height, written.tip.height);
  ASSERT_EQ(found.layers.size(), 1u);
  EXPECT_EQ(found.layers[0].poisson_ratio, 0.49);
  EXPECT_EQ(peerCaseText(found), peerCaseText(written));
}

TEST(PeerCase, ReadsASectionOfQuadraticTriangles) {
  PeerCase section = tetrahedron();
  section.dimension = section.order = 2;
  section.vertices = 3;
  section.nodes = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  section.elements = {{0, {0, 1, 2, 3, 4, 5}}};
  section.surface = {{1, 2, 4}};
  EXPECT_EQ(read(peerCaseText(section)).elements[0].nodes, section.elements[0].nodes);
  EXPECT_EQ(read(peerCaseText(section)).surface, section.surface);
}

TEST(PeerCase, PassesOverCommentsAndEmptyLines) {
  const std::string text = "# a case\n\n" + with(peerCaseText(tetrahedron()), "held 1", "held 1  # of the pipette");
  EXPECT_EQ(read(text).held, tetrahedron().held);
}

TEST(PeerCase, NamesTheLineOfAnError) {
  const std::string text = peerCaseText(tetrahedron());
  for (const auto& [piece, other] : std::vector<std::pair<std::string, std::string>>{{"peer_case 1", "peer_case 2"},
                                                                                     {"0 0 1 2 3", "0 0 1 2 4"},
                                                                                     {"0 0 1 2 3", "1 0 1 2 3"},
                                                                                     {"0 0 1 2 3", "0 0 1 2"},
                                                                                     {"0 0 1 2 3", "0 0 1 2 3 3"},
                                                                                     {"held 1", "held -1"},
                                                                                     {"held 1", "glued 1"},
                                                                                     {"17900", "nan"},
                                                                                     {"dimension 3", "dimension 4"},
                                                                                     {"end\n", ""}}) {
    SCOPED_TRACE(other);
    try {
      read(with(text, piece, other));
      ADD_FAILURE() << "was read";
    } catch (const std::runtime_error& error) {
      EXPECT_NE(std::string(error.what()).find("line "), std::string::npos) << error.what();
    }
  }
}

TEST(PeerResult, HasAForceAndATimeForEachStep) {
  PeerResult result{"program 1.0", "equilibrium", "p1", "same", "", {{{0, 0, 1e-7}, 0.001}, {{0, 0, 2e-7}, 0.002}}};
  EXPECT_EQ(peerResultText(result),
            "peer_result 1\nprogram program 1.0\nmodel equilibrium\nelement p1\nlaw same\nsteps 2\n"
            "0 0 9.9999999999999995e-08 0.001\n0 0 1.9999999999999999e-07 0.002\nend\n");
  result.declined = "discs only";
  EXPECT_NE(peerResultText(result).find("law same\ndeclined discs only\nend\n"), std::string::npos);
}

}  // namespace
}  // namespace microinjection
