#include "operation/teleoperation/virtual_fixtures.h"

#include <algorithm>

#include "base/vectors.h"

namespace microinjection {

VirtualFixturesConfig VirtualFixturesConfig::read(ConfigReader reader) {
  VirtualFixturesConfig config;
  ConfigReader guide = reader.section("guide");
  guide.boolean("enabled", config.guide);
  guide.vector("point", config.guide_point);
  guide.vector("axis", config.guide_axis);
  if (config.guide_axis.isZero()) guide.error("axis", "must not be zero");
  guide.number("stiffness", config.guide_stiffness, Range::positive());
  guide.number("force_limit", config.guide_force, Range::positive());
  ConfigReader wall = reader.section("wall");
  wall.boolean("enabled", config.wall);
  wall.vector("point", config.wall_point);
  wall.vector("normal", config.wall_normal);
  if (config.wall_normal.isZero()) wall.error("normal", "must not be zero");
  ConfigReader workspace = reader.section("workspace");
  workspace.boolean("enabled", config.workspace);
  workspace.vector("low", config.workspace_low);
  workspace.vector("high", config.workspace_high);
  if ((config.workspace_low.array() >= config.workspace_high.array()).any()) {
    workspace.error("low", "must be below high on every axis");
  }
  reader.number("stiffness", config.limit_stiffness, Range::positive());
  reader.number("force_limit", config.limit_force, Range::positive());
  return config;
}

VirtualFixtures::VirtualFixtures(const VirtualFixturesConfig& config, double position_scale)
    : config_(config), position_scale_(position_scale) {
  config_.guide_axis.normalize();
  config_.wall_normal.normalize();
}

Eigen::Vector3d VirtualFixtures::insideLimits(Eigen::Vector3d target) const {
  if (config_.wall) {
    const double depth = (config_.wall_point - target).dot(config_.wall_normal);
    target += std::max(0.0, depth) * config_.wall_normal;
  }
  if (config_.workspace) target = target.cwiseMax(config_.workspace_low).cwiseMin(config_.workspace_high);
  return target;
}

VirtualFixtures::Result VirtualFixtures::apply(const Eigen::Vector3d& target) const {
  Result result{insideLimits(target), Eigen::Vector3d::Zero()};
  const double k = config_.limit_stiffness / position_scale_;
  result.hand_force = clampedNorm(k * (result.target - target), config_.limit_force);
  if (!config_.guide) return result;
  const Eigen::Vector3d off = target - config_.guide_point;
  const Eigen::Vector3d lateral = off - off.dot(config_.guide_axis) * config_.guide_axis;
  result.hand_force += clampedNorm(-config_.guide_stiffness / position_scale_ * lateral, config_.guide_force);
  return result;
}

}  // namespace microinjection
