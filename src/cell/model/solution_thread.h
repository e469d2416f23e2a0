#pragma once

#include <Eigen/Core>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "cell/model/online_cell.h"

namespace microinjection {

/// An equilibrium and the deformation that goes with it.
struct CellSolution {
  ContactPoint place;
  IndentationSolution indentation;
  std::shared_ptr<const std::vector<Eigen::Vector3d>> rest;  ///< see TipPath
  Eigen::VectorXd displacement;                              ///< m, xyz of each vertex of the picture
  std::vector<CellModel::Member> members;
};

/// Follows a tip in a thread of its own, which makes the equations for each place, too. The asking thread never waits,
/// unless it calls wait(), and never has to free a solution.
class SolutionThread {
 public:
  explicit SolutionThread(std::shared_ptr<const OnlineCell> cell);
  ~SolutionThread();
  SolutionThread(const SolutionThread&) = delete;
  SolutionThread& operator=(const SolutionThread&) = delete;

  /// Asks for the equilibrium of a tip that moved from `place`. Returns false, and asks nothing, while the solving
  /// thread is at the exchange. @pre the answer before was taken.
  bool request(const std::shared_ptr<const ContactPoint>& place, const TipMotion& move);
  /// The answer when it is there, else, or while the solving thread is at the exchange, null. Rethrows what the solver
  /// threw.
  std::shared_ptr<const CellSolution> take();
  /// As take(), but waits for the answer. @pre an answer is due.
  std::shared_ptr<const CellSolution> wait();

 private:
  struct Request {
    std::shared_ptr<const ContactPoint> place;
    TipMotion move;
  };
  void run();
  std::shared_ptr<const CellSolution> solve(const Request& question);

  std::shared_ptr<const OnlineCell> cell_;
  std::unique_ptr<TipPath> path_;  ///< of the solving thread only
  ContactPoint place_;             ///< of the solving thread only
  /// Of the solving thread only: all that others may still have. It drops them when nobody has, so that freeing their
  /// memory is never left to the thread that asks.
  std::vector<std::shared_ptr<const CellSolution>> published_;

  std::mutex mutex_;  ///< guards what follows
  std::condition_variable changed_;
  bool stop_ = false;
  std::optional<Request> request_;
  std::shared_ptr<const CellSolution> solution_;
  std::exception_ptr failure_;

  std::thread thread_;  ///< last: starts when all else is there
};

}  // namespace microinjection
