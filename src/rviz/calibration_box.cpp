#include "rviz/calibration_box.h"

#include <QGridLayout>
#include <QLabel>
#include <utility>

#include "rviz/button_style.h"
#include "rviz/camera_task_runners.h"

namespace microinjection {

CalibrationBox::CalibrationBox(std::function<SessionView()> newest, QWidget* parent)
    : QWidget(parent), newest_(std::move(newest)), report_(new LampRow("", 4, this)) {
  auto* layout = new QGridLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setHorizontalSpacing(8);
  layout->setVerticalSpacing(4);
  layout->setColumnStretch(1, 1);
  layout->addWidget(new QLabel("<b>Needle and camera</b>", this), 0, 0, 1, 2);
  int line = 1;
  const auto add = [this, layout, &line](Row& row, const QString& name, const std::function<void()>& pressed) {
    row.button = new QPushButton(name, this);
    row.button->setFocusPolicy(Qt::NoFocus);  // a focused button would take the space bar
    row.button->setFixedSize(86, 28);
    row.button->setStyleSheet(offerStyle(false));
    row.button->setEnabled(false);
    row.text = new ElidedLabel(2, this);
    row.text->setColour(QColor(kMutedColour));
    layout->addWidget(row.button, line, 0);
    layout->addWidget(row.text, line++, 1);
    QObject::connect(row.button, &QPushButton::clicked, this, pressed);
  };
  for (const CameraTask task : kCameraTasks) {
    add(rows_[static_cast<std::size_t>(task)], toText(task), [this, task] { press(task); });
  }
  add(cancel_, "Cancel", [this] {
    if (runners_) runners_->cancel();
  });
  layout->addWidget(report_, line, 0, 1, 2);
  layout->setRowStretch(line + 1, 1);
}

CalibrationBox::~CalibrationBox() = default;

void CalibrationBox::start() {
  if (!runners_) runners_ = std::make_unique<CameraTaskRunners>();
}

void CalibrationBox::press(CameraTask task) {
  if (!runners_) return;
  runners_->poll();
  const CommandOffer offered = offer(task, newest_(), runners_->there(task), runners_->running());
  if (offered.refusal.empty()) runners_->start(task);
}

void CalibrationBox::display(Row& row, bool offered, const std::string& text) {
  if (offered != row.offered) {
    row.offered = offered;
    row.button->setEnabled(offered);
    row.button->setStyleSheet(offerStyle(offered));
    row.text->setColour(offered ? row.text->palette().color(QPalette::WindowText) : QColor(kMutedColour));
  }
  row.text->setText(QString::fromStdString(text));
}

void CalibrationBox::refresh(const SessionView& session) {
  if (!runners_) return;
  runners_->poll();
  const auto running = runners_->running();
  for (const CameraTask task : kCameraTasks) {
    const CommandOffer offered = offer(task, session, runners_->there(task), running);
    display(rows_[static_cast<std::size_t>(task)], offered.refusal.empty(),
            offered.refusal.empty() ? offered.effect : offered.refusal);
  }
  // Re-zero is over before a hand is at the button.
  const bool cancels = running && *running != CameraTask::kRezero;
  display(cancel_, cancels, cancels ? "ends the task under way; STOP does so, too" : "no task is under way");
  report_->display(reportLamp(runners_->report()));
}

}  // namespace microinjection
