#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/config_reader.h"
#include "operation/control/training_score.h"
#include "operation/record/session_table.h"

namespace microinjection {

struct TrainingConfig {
  std::string operator_name;
  std::string history;              ///< path of the CSV file of all sessions; made when absent
  std::string force = "predicted";  ///< or measured: the force that counts
  std::string punctures = "cell";   ///< those of the cell model, or felt: those that the controller has felt
  TrainingTask task;

  /// Keys operator, history (both required), force, punctures, and the section task.
  static TrainingConfig read(ConfigReader& reader);
};

/// A session as one of an operator's: scored from the rows of its table, written to training.yaml beside them and, when
/// a cell was touched, as a row of the history.
class TrainingLog {
 public:
  struct Result {
    TrainingScore score;
    bool in_history = false;
    std::string text;                 ///< for people, a few lines
    std::vector<std::string> errors;  ///< a text for each file that could not be written
  };

  explicit TrainingLog(const TrainingConfig& config) : config_(config) {}

  const TrainingConfig& config() const { return config_; }
  void add(const SessionTable::Row& row);
  /// At the end; `session`: its date, say. A file that cannot be written keeps no other from being written.
  Result finish(const std::string& folder, const std::string& session) const;

 private:
  int puncturesOf(const SessionTable::Row& row);

  TrainingConfig config_;
  std::optional<SessionTable::Cell> cell_;  ///< of the row before
  int cell_punctures_ = 0;
  TrainingSession session_;
};

}  // namespace microinjection
