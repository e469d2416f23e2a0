#pragma once

#include <Eigen/Core>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "cell/model/live_cell.h"

namespace microinjection {

/// An equilibrium with its deformation.
struct CellSolution {
  ContactPoint contact_point;
  IndentationSolution indentation;
  std::shared_ptr<const std::vector<Eigen::Vector3d>> rest;  ///< see TipPath
  Eigen::VectorXd displacement;                              ///< m, xyz of each vertex of the surface
  std::vector<CellModel::Member> members;
  std::vector<Eigen::Vector3d> border_vertices;  ///< m
};

/// Follows a tip in a separate thread, which also makes the equations of each contact point. The
/// requesting thread never blocks, except in wait(), and never frees a solution.
class SolutionThread {
 public:
  explicit SolutionThread(std::shared_ptr<const LiveCell> cell);
  ~SolutionThread();
  SolutionThread(const SolutionThread&) = delete;
  SolutionThread& operator=(const SolutionThread&) = delete;

  /// Requests the equilibrium of a tip with this contact point. Returns false without a request
  /// while the solving thread holds the lock. @pre the previous solution was received.
  bool request(const std::shared_ptr<const ContactPoint>& contact_point, const TipMotion& move);
  /// Returns the solution if it is ready, else null, also while the solving thread holds the lock.
  /// Rethrows an exception of the solver.
  std::shared_ptr<const CellSolution> poll();
  /// As poll(), but waits for the solution. @pre a solution was requested.
  std::shared_ptr<const CellSolution> wait();

 private:
  struct Request {
    std::shared_ptr<const ContactPoint> contact_point;
    TipMotion move;
  };
  void run();
  std::shared_ptr<const CellSolution> solve(const Request& request);

  std::shared_ptr<const LiveCell> cell_;
  std::unique_ptr<TipPath> path_;  ///< used by the solving thread only
  ContactPoint contact_point_;     ///< used by the solving thread only
  /// Used by the solving thread only: all solutions that others may still use. It drops those that
  /// nobody uses, so that the requesting thread never frees their memory.
  std::vector<std::shared_ptr<const CellSolution>> published_;

  std::mutex mutex_;  ///< guards the members below
  std::condition_variable changed_;
  bool stop_ = false;
  std::optional<Request> request_;
  std::shared_ptr<const CellSolution> solution_;
  std::exception_ptr failure_;

  std::thread thread_;  ///< last, so that it starts after the other members
};

}  // namespace microinjection
