#include "rviz/score_box.h"

#include <QGridLayout>
#include <QLabel>
#include <type_traits>

#include "operation/console/guard_margins.h"
#include "rviz/elided_label.h"
#include "rviz/guard_row.h"
#include "rviz/session_link.h"
#include "rviz/session_parameters.h"

namespace microinjection {
namespace {

/// `config.trainee` stays empty where the session is not scored. Returns the values that are no numbers.
std::string readTraining(const Bus& bus, TrainingConfig& config) {
  SessionParameters parameters(bus, "/session_recorder/training");
  config.trainee = parameters.text("trainee");
  if (config.trainee.empty()) return "";
  if (const std::string force = parameters.text("force"); !force.empty()) config.force = force;
  if (const std::string punctures = parameters.text("punctures"); !punctures.empty()) config.punctures = punctures;
  const auto read = [&parameters](const char* key, auto& value) {
    using Number = std::decay_t<decltype(value)>;
    if (const auto number = parameters.number(std::string("task/") + key)) value = static_cast<Number>(*number);
  };
  read("peak_force", config.task.peak_force);
  read("deformation", config.task.deformation);
  read("lateral_error", config.task.lateral_error);
  read("time", config.task.time);
  read("volume", config.task.volume);
  read("punctures", config.task.punctures);
  return parameters.error();
}

}  // namespace

ScoreBox::ScoreBox(QWidget* parent) : QWidget(parent), text_(new ElidedLabel(1, this)) {
  auto* layout = new QGridLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setHorizontalSpacing(12);
  layout->setVerticalSpacing(2);
  auto* title = new QLabel("<b>Score so far</b>", this);
  layout->addWidget(title, 0, 0);
  layout->addWidget(text_, 0, 1);
  constexpr int kMeasures = 6, kColumns = 2;
  for (int i = 0; i < kMeasures; ++i) {
    rows_.push_back(new GuardRow(this, "deformation ", "00.00 of 00.00 uN "));
    layout->addWidget(rows_.back(), 1 + i / kColumns, i % kColumns);
  }
  text_->setText("this session is not scored: start it with record:=FOLDER set:=record.trainee=NAME");
}

void ScoreBox::start(const Bus& bus, SessionLink& link) {
  TrainingConfig config;
  if (log_) return;
  const std::string error = readTraining(bus, config);
  // A score against another reference than the recorder's would be a wrong one.
  if (!error.empty()) text_->setText(QString::fromStdString(error));
  if (config.trainee.empty() || !error.empty()) return;
  log_ = std::make_unique<TrainingLog>(config);
  link.onRow([this](const SessionTable::Row& row) { log_->add(row); });
}

void ScoreBox::refresh() {
  if (!log_) return;
  const TrainingScore score = log_->score();
  text_->setText(QString::fromStdString(log_->config().trainee + ": " + scoreText(score)));
  const auto margins = scoreMargins(score, log_->config().task);
  for (std::size_t i = 0; i < rows_.size(); ++i) rows_[i]->display(margins[i]);
}

}  // namespace microinjection
