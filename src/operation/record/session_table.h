#pragma once

#include <Eigen/Core>
#include <functional>
#include <limits>
#include <optional>
#include <sstream>
#include <string>
#include <utility>

#include "operation/record/timeline.h"

namespace microinjection {

/// The rows of force_depth.csv, one each period: every source is asked for what it said at that time, by the stamps of
/// what it said. It therefore does not matter when a message arrived, as long as it did within `patience`: a recorder
/// that the scheduler lets wait writes the same rows as one that is always prompt. What comes later than that counts
/// for the rows that are not written yet. A row is given away when it is due: the table keeps only what later ones
/// need.
///
/// Depth is the tip's travel along the pipette from where the cell says that it was touched, for the needle's pose that
/// the predicted force belongs to (they have the same stamp); empty before the first touch.
class SessionTable {
 public:
  struct Pose {
    Eigen::Vector3d tip = Eigen::Vector3d::Zero();    ///< m
    Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< out of the cell
  };
  struct Measured {
    double axial = 0, lateral = 0;  ///< N
  };
  struct Cell {
    std::optional<Eigen::Vector3d> contact_point;  ///< m, where the tip met the surface; empty without contact
    bool punctured = false;
    unsigned layers_punctured = 0;  ///< where the needle is or was last
    std::size_t holes = 0;          ///< in the outermost layer
  };

  /// Of the injection, as the controller sees it.
  struct Injection {
    std::string state;
    int punctures = 0;  ///< felt since the needle set out
  };
  /// A row; what was not valid at its time is empty.
  struct Row {
    double time = 0;  ///< s, of the table
    std::optional<Pose> needle;
    std::optional<Eigen::Vector3d> predicted;  ///< N, of the cell on the tip; only with a needle
    std::optional<Measured> measured;
    std::optional<double> hand_force;  ///< N
    std::optional<double> depth;       ///< m; empty before the first touch and without a needle
    bool in_contact = false;
    std::string phase, injection;  ///< empty: not told yet
    Cell cell;
    int punctures = 0;             ///< that the controller has felt since the needle set out
    std::optional<double> volume;  ///< m^3
  };

  /// Takes a row as it stands in the file, a line with its end.
  using Sink = std::function<void(const std::string& line)>;
  static const char* const kHeader;  ///< the file's first line, with its end

  /// @param period    ns between rows
  /// @param patience  ns for which a row waits for messages that are late
  /// @param sink      gets every row that is due, in order
  SessionTable(Nanoseconds period, Nanoseconds patience, Sink sink);

  // What the sources say, N and m. Force in the frame of the poses.
  Timeline<Pose> needle;
  Timeline<Eigen::Vector3d> predicted;
  Timeline<Measured> measured;
  Timeline<double> hand_force;
  Timeline<std::string> phase;
  Timeline<Cell> cell;
  Timeline<Injection> injection;
  Timeline<double> volume;  ///< m^3, net, out of the pipette

  /// Sees every row when it is written.
  void onRow(std::function<void(const Row&)> listener) { listener_ = std::move(listener); }

  /// Writes the rows that are due `patience` before `now`; the first call is time 0 of the table. After the row in
  /// which the phase is `done` there are no more. Where `now` leaps by more than a minute, ahead or back,
  /// there are no rows for the time in between.
  void advance(Nanoseconds now);
  /// Writes what is left, without patience.
  void finish();

  bool done() const { return done_; }
  double duration() const;  ///< s, of the rows

 private:
  void advanceTo(Nanoseconds end);
  void skipTo(Nanoseconds now);
  Row row(Nanoseconds time);
  std::optional<double> depth(Nanoseconds time, const Pose& pose, bool in_contact);
  void write(const Row& row);
  void discardBefore(Nanoseconds time);
  void clear();

  Nanoseconds period_, patience_;
  std::optional<Nanoseconds> began_;
  Nanoseconds next_ = 0;  ///< time of the row that is due next
  Nanoseconds seen_ = 0;  ///< newest `now`
  bool done_ = false;
  bool in_contact_ = false;                    ///< of the last row
  std::optional<Eigen::Vector3d> touched_at_;  ///< m, last; empty before the first touch
  std::function<void(const Row&)> listener_;
  Sink sink_;
  std::ostringstream line_;  ///< the row that is written
};

}  // namespace microinjection
