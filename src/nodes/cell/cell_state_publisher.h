#pragma once

#include <ros/ros.h>

#include <array>
#include <atomic>
#include <optional>
#include <string>
#include <thread>

#include "base/latest_value.h"
#include "cell/model/cell_model.h"
#include "cell_microinjection/CellState.h"
#include "nodes/runtime/ports.h"

namespace microinjection {

/// What a step of the cell simulator found, but for the surface.
struct CellMoment {
  ros::Time now;
  TipForce force;
  std::optional<CellModel::Contact> contact;
  std::optional<CellModel::Solution> solution;
  CellModel::Insertion insertion;
  bool valid = true;
  std::array<char, 200> reason{};  ///< why the force is not valid, cut where it is too long

  void setReason(const std::string& text);
};

/// Makes /cell/state, surface and all, at its own rate from what the steps hand over. Live, in a thread of its own of
/// ordinary priority, so that a step neither makes nor sends it; in lock step in the step that
/// is due, so that it is the same in every run.
class CellStatePublisher {
 public:
  enum class Thread { kOwn, kOfTheStep };

  /// @param rate  Hz. `cell` and `output` outlive it.
  CellStatePublisher(CellModel& cell, Output<cell_microinjection::CellState>& output, double rate, Thread thread);
  ~CellStatePublisher();
  CellStatePublisher(const CellStatePublisher&) = delete;
  CellStatePublisher& operator=(const CellStatePublisher&) = delete;

  /// After each step of the cell, in its thread.
  void step(const CellMoment& moment);

 private:
  void run();
  void publish(const CellMoment& moment);
  void fillSurface(cell_microinjection::CellState& state);

  CellModel& cell_;
  Output<cell_microinjection::CellState>& output_;
  double period_;                              ///< s
  cell_microinjection::CellState undeformed_;  ///< what stays the same in every message
  ros::Time sent_;                             ///< in lock step
  LatestValue<CellMoment> moment_;
  std::atomic<bool> stop_{false};
  std::thread thread_;  ///< last: starts when all else is there
};

}  // namespace microinjection
