#pragma once

#include <map>
#include <optional>
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

/// What hinders a session, from what its nodes say of themselves on /diagnostics and of their loops.
///
///     micromanipulator --> cell --> sensor --> injector --> controller --> bridge --> device --> images
///     no position          no tip   no force                no needle      no needle  no force
///          ^
///          '-- given first: the others are its consequences
///
/// Reasons hide each other. Without a position of the needle the cell, the controller and the hand complain, too, and
/// a list by severity shows them all alike, although all but one mend themselves. Reasons are therefore given from
/// the devices towards the hand, what is only information last, and a lost ROS master before all: whoever mends the
/// first one does nothing in vain. A graph of causes would be exact, but it would have to know each reason of each
/// node; the order of the nodes is enough, and holds for reasons that are new.
///
/// A node that says nothing is a reason as well, because a node that was killed or is frozen cannot complain. What
/// was said holds until it is said anew, or for kSilence.
///
/// The remedies are those of the troubleshooting page (Remedies), so that the page and the program cannot differ. All
/// is for one thread: functions that are const keep remedies that they have looked up.
class Readiness {
 public:
  /// @param nodes  that the session has, without '/'
  /// @param remedies  must outlive this object
  Readiness(std::vector<std::string> nodes, const Remedies& remedies);

  /// @param time  s, of a clock that is never set back
  void hearStatus(const std::string& node, const std::string& status, Hindrance::Level level,
                  const std::string& message, double time);
  /// Of a node whose loop may hold the needle: micromanipulator, controller or bridge.
  /// @param hold_reason  empty: it follows
  void hearLoop(const std::string& node, const std::string& hold_reason, double time);

  /// The first one is to be mended first. `time`: as above.
  std::vector<Hindrance> hindrances(double time) const;
  /// Whether the needle follows: every loop of the session's nodes does, each of them was heard, and none has an error.
  bool isReady(double time) const;

  static constexpr double kSilence = 3.5;  ///< s, without a word of a node; by default nodes report once a second
  static constexpr double kStart = 30;     ///< s, from the session's first word to that of a node that starts slowly

 private:
  /// What a status says, or why a loop holds the needle: true until it is said anew, or for kSilence.
  struct Said {
    std::string message;
    double time = 0;  ///< s
    Hindrance::Level level = Hindrance::Level::kInformation;
  };
  struct Node {
    double heard = 0;  ///< s
    std::map<std::string, Said> statuses;
    std::optional<Said> loop;
  };

  static bool isFresh(const Said& said, double time) { return time - said.time <= kSilence; }
  void addOf(const std::string& name, const Node& node, double time, std::vector<Hindrance>& all) const;
  /// Of a node that the session has: that it has not said anything yet, or does not any more.
  void addSilence(const std::string& name, double time, std::vector<Hindrance>& all) const;
  bool follows(const std::string& name, double time) const;
  Hindrance hindrance(const std::string& node, const std::string& status, Hindrance::Level level,
                      const std::string& reason) const;

  std::vector<std::string> expected_;
  const Remedies& remedies_;
  mutable std::map<std::string, std::optional<Remedies::Remedy>> known_;  ///< remedies that were looked up, by reason
  std::map<std::string, Node> nodes_;
  double begin_ = -1;  ///< s, of the first word of any node
};

}  // namespace microinjection
