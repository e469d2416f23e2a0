#pragma once

#include <ros/time.h>

#include <array>
#include <atomic>
#include <optional>
#include <string>
#include <thread>

#include "base/latest_value.h"
#include "cell/model/placed_cell.h"
#include "cell/model/scene.h"
#include "cell_microinjection/CellState.h"
#include "nodes/runtime/ports.h"

namespace microinjection {

/// Result of a step of the cell simulator, without the surface.
struct CellMoment {
  ros::Time now;
  TipForce force;
  std::optional<CellModel::Contact> contact;
  std::optional<CellModel::Solution> solution;
  std::optional<double> force_error;  ///< N
  CellModel::Insertion insertion;
  bool valid = true;
  std::array<char, 200> reason{};  ///< why the force is invalid, truncated

  void setReason(const std::string& text);
};

/// Publishes /cell/state with the surface at its own rate from the results of the steps. Live it
/// uses its own thread of ordinary priority, so that no step is delayed. In virtual
/// time it publishes in the step that is due, so that all runs are the same.
class CellStatePublisher {
 public:
  enum class Thread { kOwn, kOfTheStep };

  /// @param scene  of the start
  /// @param rate   Hz. `cell` and `output` outlive it.
  CellStatePublisher(PlacedCell& cell, const Scene& scene, Output<cell_microinjection::CellState>& output, double rate,
                     Thread thread);
  ~CellStatePublisher();
  CellStatePublisher(const CellStatePublisher&) = delete;
  CellStatePublisher& operator=(const CellStatePublisher&) = delete;

  /// Call after each step of the cell, in the step's thread.
  void step(const CellMoment& moment);

 private:
  void run();
  void publish(const CellMoment& moment);
  void fillSurface(const CellMoment& moment, cell_microinjection::CellState& state);

  PlacedCell& cell_;
  Scene scene_;
  Output<cell_microinjection::CellState>& output_;
  double period_;                              ///< s
  cell_microinjection::CellState undeformed_;  ///< the constant part of every message
  ros::Time sent_;                             ///< without a thread
  LatestValue<CellMoment> moment_;
  std::atomic<bool> stop_{false};
  std::thread thread_;  ///< last member: starts after the others are initialised
};

}  // namespace microinjection
