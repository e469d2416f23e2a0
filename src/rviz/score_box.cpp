#include "rviz/score_box.h"

#include <ros/param.h>

#include <QGridLayout>
#include <QLabel>

#include "operation/console/score_lines.h"
#include "rviz/elided_label.h"
#include "rviz/guard_row.h"
#include "rviz/session_link.h"

namespace microinjection {
namespace {

constexpr char kParameters[] = "/session_recorder/training/";

void read(const std::string& name, double& value) { ros::param::get(kParameters + ("task/" + name), value); }

/// False: the session is not scored.
bool readTraining(TrainingConfig& config) {
  if (!ros::param::get(std::string(kParameters) + "operator", config.operator_name)) return false;
  ros::param::get(std::string(kParameters) + "force", config.force);
  ros::param::get(std::string(kParameters) + "punctures", config.punctures);
  read("peak_force", config.task.peak_force);
  read("deformation", config.task.deformation);
  read("lateral_error", config.task.lateral_error);
  read("time", config.task.time);
  read("volume", config.task.volume);
  ros::param::get(std::string(kParameters) + "task/punctures", config.task.punctures);
  return true;
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
  text_->setText("this session is not scored: start it with record:=FOLDER operator:=NAME");
}

void ScoreBox::start(SessionLink& link) {
  TrainingConfig config;
  if (log_ || !readTraining(config)) return;
  log_ = std::make_unique<TrainingLog>(config);
  link.onRow([this](const SessionTable::Row& row) { log_->add(row); });
}

void ScoreBox::refresh() {
  if (!log_) return;
  const TrainingScore score = log_->score();
  text_->setText(QString::fromStdString(log_->config().operator_name + ": " + scoreText(score)));
  const auto margins = scoreMargins(score, log_->config().task);
  for (std::size_t i = 0; i < rows_.size(); ++i) rows_[i]->display(margins[i]);
}

}  // namespace microinjection
