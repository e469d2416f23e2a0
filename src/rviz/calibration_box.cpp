#include "rviz/calibration_box.h"

#include <utility>

#include "rviz/camera_task_runners.h"

namespace microinjection {

CalibrationBox::CalibrationBox(std::function<SessionView()> newest, QWidget* parent)
    : QWidget(parent), newest_(std::move(newest)), report_(new LampRow("", 2, this)) {
  QGridLayout* layout = boxLayout(this, "Needle and camera");
  int line = 1;
  for (const CameraTask task : kCameraTasks)
    rows_.emplace_back(toText(task), 1, this, layout, line++, [this, task] { press(task); });
  cancel_ = new OfferButton("Cancel", this, [this] {
    if (runners_) runners_->cancel();
  });
  cancel_->setFixedSize(86, 28);
  cancel_->setToolTip("Ends the task under way; STOP does so, too");
  layout->addWidget(cancel_, line, 0);
  layout->addWidget(report_, line, 1);
  layout->setRowStretch(line + 1, 1);
}

CalibrationBox::~CalibrationBox() = default;

void CalibrationBox::start(const std::shared_ptr<Bus>& bus) {
  if (!runners_) runners_ = std::make_unique<CameraTaskRunners>(bus);
}

void CalibrationBox::press(CameraTask task) {
  if (!runners_) return;
  runners_->poll();
  const CommandOffer offered = offer(task, newest_(), runners_->there(task), runners_->running());
  if (offered.refusal.empty()) runners_->start(task);
}

void CalibrationBox::refresh(const SessionView& session) {
  if (!runners_) return;
  runners_->poll();
  const auto running = runners_->running();
  for (const CameraTask task : kCameraTasks) {
    rows_[static_cast<std::size_t>(task)].display(offer(task, session, runners_->there(task), running));
  }
  cancel_->offer(running && !isService(*running));
  report_->display(reportLamp(runners_->report()));
}

}  // namespace microinjection
