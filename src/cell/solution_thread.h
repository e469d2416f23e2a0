#pragma once

#include <Eigen/Core>
#include <condition_variable>
#include <exception>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "cell/live_cell.h"

namespace microinjection {

/// An equilibrium and the deformation that goes with it.
struct CellSolution {
  TipPatch patch;
  IndentationSolution indentation;
  Eigen::VectorXd displacement;  ///< m, xyz per vertex of the mesh
  std::vector<CellUnderNeedle::Member> members;
};

/// Solves indentations one after the other in a thread of its own. The asking thread never waits, unless it calls
/// wait(), and never has to free a solution.
class SolutionThread {
 public:
  explicit SolutionThread(std::shared_ptr<const LiveCell> cell);
  ~SolutionThread();
  SolutionThread(const SolutionThread&) = delete;
  SolutionThread& operator=(const SolutionThread&) = delete;

  /// Asks for the equilibrium of `patch` at a tip displacement (m) at `time` (s; a viscous cell has had since the
  /// question before, or for ever where that was of another patch). Returns false, and asks nothing, while the solving
  /// thread is at the exchange. @pre the answer before was taken.
  bool ask(const std::shared_ptr<const TipPatch>& patch, const Eigen::Vector3d& tip_displacement, double time);
  /// The answer when it is there, else, or while the solving thread is at the exchange, null. Rethrows what the solver
  /// threw.
  std::shared_ptr<const CellSolution> take();
  /// As take(), but waits for the answer. @pre an answer is due.
  std::shared_ptr<const CellSolution> wait();

 private:
  struct Question {
    std::shared_ptr<const TipPatch> patch;
    Eigen::Vector3d tip_displacement;
    double time;  ///< s
  };
  void run();
  std::shared_ptr<const CellSolution> solve(const Question& question);

  std::shared_ptr<const LiveCell> cell_;
  std::unique_ptr<LiveIndentation> indentation_;  ///< of the solving thread only
  double solved_for_ = 0;                         ///< s, of the solving thread only: time of its last question
  TipPatch patch_;                                ///< of the solving thread only
  /// Of the solving thread only: all that others may still have. It drops them when nobody has, so that freeing their
  /// memory is never left to the thread that asks.
  std::vector<std::shared_ptr<const CellSolution>> given_;

  std::mutex mutex_;  ///< guards what follows
  std::condition_variable changed_;
  bool stop_ = false;
  std::optional<Question> question_;
  std::shared_ptr<const CellSolution> answer_;
  std::exception_ptr failure_;

  std::thread thread_;  ///< last: starts when all else is there
};

}  // namespace microinjection
