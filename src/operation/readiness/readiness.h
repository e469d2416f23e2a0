#pragma once

#include <map>
#include <string>
#include <vector>

#include "operation/readiness/remedies.h"

namespace microinjection {

/// A reason why a session does not do what it is asked to.
struct Hindrance {
  enum class Level { kInformation, kWarning, kError };

  std::string node, status;  ///< status: as on /diagnostics, or "loop" of one that holds the needle
  Level level = Level::kInformation;
  bool holds = false;                   ///< the needle, by its node
  std::string reason, remedy, section;  ///< section of doc/guide/troubleshooting.md
};

/// What hinders a session, from what its nodes say of themselves. Reasons hide each other: without a position of the
/// needle the cell, the controller and the hand complain, too. They are therefore given from the devices towards the
/// hand: the first one is to be mended first.
class Readiness {
 public:
  /// @param nodes  that the session has, without '/'
  Readiness(std::vector<std::string> nodes, const Remedies& remedies);

  /// @param time  s, of a clock that is never set back
  void hearStatus(const std::string& node, const std::string& status, Hindrance::Level level,
                  const std::string& message, double time);
  /// Of a node whose loop may hold the needle. @param hold_reason  empty: it follows
  void hearLoop(const std::string& node, const std::string& hold_reason, double time);

  /// The most important first.
  std::vector<Hindrance> hindrances(double time) const;
  /// Whether the needle follows: every loop that was heard does, and no node has an error.
  bool isReady(double time) const;

  static constexpr double kSilence = 3.5;  ///< s, without a word of a node, and of the session's start

 private:
  struct Said {
    Hindrance::Level level = Hindrance::Level::kInformation;
    std::string message;
  };
  struct Node {
    double heard = 0;  ///< s
    std::map<std::string, Said> statuses;
    std::string hold_reason;
    bool has_loop = false;
  };

  Hindrance hindrance(const std::string& node, const std::string& status, Hindrance::Level level,
                      const std::string& reason) const;

  std::vector<std::string> expected_;
  const Remedies& remedies_;
  std::map<std::string, Node> nodes_;
  double begin_ = -1;  ///< s, of the first word of any node
};

}  // namespace microinjection
