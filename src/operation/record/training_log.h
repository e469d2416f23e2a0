#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/config_reader.h"
#include "operation/control/training_score.h"
#include "operation/record/session_table.h"

namespace microinjection {

struct TrainingConfig {
  std::string trainee;
  std::string history;              ///< path of the CSV file of all sessions; created when absent
  std::string force = "predicted";  ///< the scored force: predicted or measured
  std::string punctures = "cell";   ///< cell: those of the cell model; felt: those detected by the controller
  TrainingTask task;

  /// Keys trainee, history (both required), force, punctures, and the section task.
  static TrainingConfig read(ConfigReader& reader);
};

/// Scores an trainee's session from the rows of its table. Writes training.yaml beside the table
/// and, after a contact, a row of the history.
class TrainingLog {
 public:
  struct Result {
    TrainingScore score;
    bool in_history = false;
    std::string text;                 ///< for people, a few lines
    std::vector<std::string> errors;  ///< one for each file that could not be written
  };

  explicit TrainingLog(const TrainingConfig& config) : config_(config) {}

  const TrainingConfig& config() const { return config_; }
  void add(const SessionTable::Row& row);
  /// What the session would be scored if it ended now.
  TrainingScore score() const { return session_.score(config_.task); }
  /// Call at the end; `session` is its name, for example its date. Each file is written even when
  /// another cannot be.
  Result finish(const std::string& folder, const std::string& session) const;

 private:
  int puncturesOf(const SessionTable::Row& row);

  TrainingConfig config_;
  std::optional<SessionTable::Cell> cell_;  ///< of the last row
  int cell_punctures_ = 0;
  TrainingSession session_;
};

}  // namespace microinjection
