#pragma once

#include <Eigen/Core>
#include <functional>
#include <optional>
#include <sstream>
#include <string>
#include <utility>

#include "operation/record/timeline.h"

namespace microinjection {

/// The rows of force_depth.csv, one per period. Each row has the values of all sources at its time,
/// by the stamps of their messages. The time of arrival does not matter within `max_delay`: a
/// recorder delayed by the scheduler writes the same rows. Later messages only affect rows that are
/// not written yet. A row is written when it is due, and the table keeps only what later rows need.
///
/// Depth is the tip's travel along the pipette from the contact point that the cell reports. Its
/// needle pose is that of the predicted force (same stamp). It is empty before the first contact.
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
    std::optional<Eigen::Vector3d> contact_point;  ///< m; empty without contact
    bool punctured = false;
    unsigned layers_punctured = 0;  ///< at the needle's present or last position
    std::size_t holes = 0;          ///< in the outermost layer
  };

  /// The injection as the controller reports it.
  struct Injection {
    std::string state;
    int punctures = 0;  ///< detected since the needle started
  };
  /// A row; values that were invalid at its time are empty.
  struct Row {
    double time = 0;  ///< s, of the table
    std::optional<Pose> needle;
    std::optional<Eigen::Vector3d> predicted;  ///< N, of the cell on the tip; only with a needle
    std::optional<Measured> measured;
    std::optional<double> hand_force;  ///< N
    std::optional<double> depth;       ///< m; empty before the first contact and without a needle
    bool in_contact = false;
    std::string phase, injection;  ///< empty: not received yet
    Cell cell;
    int punctures = 0;             ///< detected by the controller since the needle started
    std::optional<double> volume;  ///< m^3
  };

  /// Receives a row as a line of the file, with its line break.
  using Sink = std::function<void(const std::string& line)>;
  static const char* const kHeader;  ///< the file's first line, with its line break

  /// @param period    ns between rows
  /// @param max_delay  ns that a row waits for late messages
  /// @param sink      receives the rows in order
  SessionTable(Nanoseconds period, Nanoseconds max_delay, Sink sink);

  // The values of the sources, N and m. Forces are in the frame of the poses.
  Timeline<Pose> needle;
  Timeline<Eigen::Vector3d> predicted;
  Timeline<Measured> measured;
  Timeline<double> hand_force;
  Timeline<std::string> phase;
  Timeline<Cell> cell;
  Timeline<Injection> injection;
  Timeline<double> volume;  ///< m^3, net, out of the pipette

  /// `handler` receives every row when it is written.
  void onRow(std::function<void(const Row&)> handler) { row_handler_ = std::move(handler); }

  /// Writes the rows up to `max_delay` before `now`; the first call is time 0 of the table. The
  /// rows end with the phase `done`. When `now` jumps by more than a minute, ahead or back, there
  /// are no rows for the time in between.
  void advance(Nanoseconds now);
  /// Writes the remaining rows without delay.
  void finish();

  bool done() const { return done_; }
  double duration() const;  ///< s, of the rows

 private:
  void advanceTo(Nanoseconds end);
  void skipTo(Nanoseconds now);
  Row row(Nanoseconds time);
  std::optional<double> depth(Nanoseconds time, const Pose& pose, bool in_contact);
  void write(const Row& row);
  template <typename Function>
  void forEachButNeedle(const Function& function);
  void discardBefore(Nanoseconds time);
  void clear();

  Nanoseconds period_, max_delay_;
  std::optional<Nanoseconds> began_;
  Nanoseconds next_ = 0;  ///< time of the next row
  Nanoseconds seen_ = 0;  ///< newest `now`
  bool done_ = false;
  bool in_contact_ = false;                       ///< of the last row
  std::optional<Eigen::Vector3d> contact_point_;  ///< m, last; empty before the first contact
  std::function<void(const Row&)> row_handler_;
  Sink sink_;
  std::ostringstream line_;  ///< the row under construction
};

}  // namespace microinjection
