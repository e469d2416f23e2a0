#pragma once

#include <QWidget>
#include <memory>
#include <vector>

#include "nodes/bus/bus.h"
#include "operation/record/training_log.h"

namespace microinjection {

class ElidedLabel;
class GuardRow;
class SessionLink;

/// The score of a training session so far: each measure with its reference. The recorder's score at
/// the end is the one that counts; a console that is opened late knows less.
class ScoreBox : public QWidget {
 public:
  explicit ScoreBox(QWidget* parent = nullptr);
  /// Reads the references of the session_recorder, and listens to the session.
  void start(const Bus& bus, SessionLink& link);
  void refresh();

 private:
  ElidedLabel* text_;
  std::vector<GuardRow*> rows_;
  std::unique_ptr<TrainingLog> log_;  ///< null: the session is not scored
};

}  // namespace microinjection
