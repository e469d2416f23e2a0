#include "cell/material/surface_stress.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

#include "cell/material/volume.h"
#include "material_cases.h"

namespace microinjection {
namespace {

std::unique_ptr<Material> material(const std::string& model, double poisson_ratio = 0.49) {
  MaterialConfig config;
  config.model = model;
  config.young_modulus = kYoung;
  config.poisson_ratio = poisson_ratio;
  return makeMaterial(config);
}

SurfacePiece pieceUnder(const Eigen::Matrix3d& F) {
  SurfacePiece piece;
  piece.rest << 1e-6, 0.3e-6, 0.2e-6, 1.1e-6, 0.1e-6, -0.4e-6;
  piece.deformed = F * piece.rest;
  return piece;
}

Eigen::Vector3d normalOf(const SurfacePiece::Edges& edges) { return edges.col(0).cross(edges.col(1)).normalized(); }

/// A sheet of stretch a in both directions, without a load on its faces: neo-Hookean with lambda ln J = mu (1 - b^2)
/// across it, b the stretch there.
TEST(SurfaceStress, IsThatOfAStretchedSheet) {
  const double stretch = 1.3, poisson_ratio = 0.4;
  const Lame lame = Lame::from(kYoung, poisson_ratio);
  double thin = 1;
  for (int i = 0; i < 200; ++i) thin = std::exp(lame.mu / lame.lambda * (1 - thin * thin)) / (stretch * stretch);
  const Eigen::Matrix3d turn = Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  SurfacePiece piece = pieceUnder(Eigen::Matrix3d::Identity());
  piece.deformed = stretch * turn * piece.rest;
  const auto law = material("neo_hookean", poisson_ratio);
  const auto F = deformationBehind(piece, *law, 0);
  ASSERT_TRUE(F);
  EXPECT_NEAR((*F * normalOf(piece.rest) - thin * turn * normalOf(piece.rest)).norm(), 0, 1e-8);
  const double J = stretch * stretch * thin;
  const double in_plane = (lame.mu * (stretch * stretch - 1) + lame.lambda * std::log(J)) / J;
  const Eigen::Matrix3d stress = cauchyStress(*law, *F);
  EXPECT_NEAR(vonMisesStress(stress), in_plane, 1e-6 * in_plane);
  EXPECT_NEAR(pressureOf(stress), -2 * in_plane / 3, 1e-6 * in_plane);
}

TEST(SurfaceStress, OfALinearSheetIsThatOfPlaneStress) {
  const double strain = 0.01, poisson_ratio = 0.49;
  const SurfacePiece piece = pieceUnder((1 + strain) * Eigen::Matrix3d::Identity());
  const auto law = material("linear", poisson_ratio);
  const auto F = deformationBehind(piece, *law, 0);
  ASSERT_TRUE(F);
  EXPECT_NEAR(vonMisesStress(cauchyStress(*law, *F)), kYoung * strain / (1 - poisson_ratio), 1e-6 * kYoung * strain);
}

TEST(SurfaceStress, CarriesThePressureOnTheDeformedSurface) {
  const double pressure = 2e3;
  for (const std::string& model : materialModels()) {
    const auto law = material(model);
    for (const Eigen::Matrix3d& given : deformations(8)) {
      const SurfacePiece piece = pieceUnder(Eigen::Matrix3d::Identity() + 0.3 * (given - Eigen::Matrix3d::Identity()));
      const auto F = deformationBehind(piece, *law, pressure);
      ASSERT_TRUE(F) << model;
      EXPECT_NEAR((*F * piece.rest - piece.deformed).norm(), 0, 1e-12 * piece.rest.norm()) << model;
      const Eigen::Vector3d out = law->isLinear() ? normalOf(piece.rest) : normalOf(piece.deformed);
      EXPECT_NEAR((cauchyStress(*law, *F) * out + pressure * out).norm(), 0, 1e-5 * pressure) << model;
    }
  }
}

/// The energy of the neighbours is higher, and its first difference is zero.
TEST(SurfaceStress, ColumnIsStationaryByFiniteDifferences) {
  const double pressure = 1e3, step = 1e-4;
  for (const std::string& model : materialModels()) {
    const auto law = material(model);
    const SurfacePiece piece = pieceUnder(Eigen::Matrix3d::Identity() +
                                          0.3 * Eigen::Matrix3d{{0.2, 0.1, 0}, {-0.1, 0.3, 0.2}, {0, 0.1, -0.2}});
    const auto F = deformationBehind(piece, *law, pressure);
    ASSERT_TRUE(F) << model;
    const Eigen::Vector3d N = normalOf(piece.rest);
    const Eigen::Vector3d load = law->isLinear() ? N : Eigen::Vector3d(cofactors(*F) * N);
    const auto energy = [&](const Eigen::Vector3d& moved) {
      return law->energyDensity(*F + moved * N.transpose()) + pressure * load.dot(*F * N + moved);
    };
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d unit = step * Eigen::Vector3d::Unit(i);
      const double second = energy(unit) + energy(-unit) - 2 * energy(Eigen::Vector3d::Zero());
      EXPECT_GT(second, 0) << model;
      EXPECT_NEAR(energy(unit) - energy(-unit), 0, 2e-3 * second) << model;
    }
  }
}

/// A surface that is pressed together: the column that would keep the volume is longer than the material bears.
TEST(SurfaceStress, IsFoundWithinTheLimitOfTheMaterial) {
  const double limit = MaterialConfig().gent_limit;
  const auto law = material("gent", 0.3);
  const SurfacePiece piece = pieceUnder(0.4 * Eigen::Matrix3d::Identity());
  ASSERT_GT(2 * std::pow(0.4, 2) + std::pow(0.4, -4) - 3, limit);
  const auto F = deformationBehind(piece, *law, 0);
  ASSERT_TRUE(F);
  EXPECT_LT(F->squaredNorm() - 3, limit);
  EXPECT_NEAR((law->stress(*F) * normalOf(piece.rest)).norm(), 0, 1e-6 * kYoung);
  // And none where the surface alone is beyond it.
  EXPECT_FALSE(deformationBehind(pieceUnder(5 * Eigen::Matrix3d::Identity()), *law, 0));
}

TEST(SurfaceStress, HasNoneOfADegeneratePiece) {
  SurfacePiece piece = pieceUnder(Eigen::Matrix3d::Identity());
  piece.deformed.col(1) = piece.deformed.col(0);
  EXPECT_FALSE(deformationBehind(piece, *material("neo_hookean"), 0));
}

/// A square of two triangles and a third one beside it.
LoadedSurface strip() {
  LoadedSurface surface;
  const double a = 1e-6;
  surface.rest = {{0, 0, 0}, {a, 0, 0}, {a, a, 0}, {0, a, 0}, {2 * a, 0, 0}};
  surface.triangles = {{0, 1, 2}, {0, 2, 3}, {1, 4, 2}};
  for (const Eigen::Vector3d& vertex : surface.rest) surface.deformed.emplace_back(1.2 * vertex);
  surface.touched.assign(5, false);
  surface.held.assign(5, false);
  return surface;
}

TEST(SurfaceStressField, OfAHomogeneousStretchIsTheSameEverywhere) {
  const LoadedSurface surface = strip();
  const SurfaceStressField field = surfaceStress(surface, *material("neo_hookean"), 0);
  const double thin = field.normal_column[0].z();
  EXPECT_NEAR(thin, 1 / (1.2 * 1.2), 0.01);  // nearly incompressible
  for (std::size_t i = 0; i < surface.rest.size(); ++i) {
    EXPECT_NEAR(field.von_mises[i], field.von_mises[0], 1e-9 * field.von_mises[0]);
    EXPECT_NEAR(field.pressure[i], -2 * field.von_mises[i] / 3, 1e-6 * field.von_mises[0]);
  }
}

TEST(SurfaceStressField, IsNotKnownBetweenHeldVertices) {
  LoadedSurface surface = strip();
  surface.held = {true, true, true, false, false};
  const SurfaceStressField field = surfaceStress(surface, *material("neo_hookean"), 0);
  EXPECT_TRUE(std::isfinite(field.von_mises[0]));  // from the triangle that is not held
  surface.held = {true, true, true, true, true};
  EXPECT_TRUE(std::isnan(surfaceStress(surface, *material("neo_hookean"), 0).von_mises[0]));
}

TEST(SurfaceStressField, MeanPressureIsTheNormalForceOverTheDeformedArea) {
  LoadedSurface surface = strip();
  const Eigen::Vector3d force(3e-6, 0, 1e-6);
  EXPECT_EQ(meanContactPressure(surface, force), 0);
  surface.touched[3] = true;  // a vertex of one triangle
  EXPECT_NEAR(meanContactPressure(surface, force), 1e-6 / (1.2e-6 * 1.2e-6 / 2 / 3), 1);
  surface.touched.assign(5, true);
  EXPECT_NEAR(meanContactPressure(surface, force), 1e-6 / (1.5 * 1.2e-6 * 1.2e-6), 1);
  EXPECT_EQ(meanContactPressure(surface, -force), 0);
}

}  // namespace
}  // namespace microinjection
