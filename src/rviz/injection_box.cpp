#include "rviz/injection_box.h"

#include "rviz/session_clock.h"

namespace microinjection {

using cell_microinjection::InjectFeedback;
using cell_microinjection::InjectGoal;
using cell_microinjection::InjectResult;

template <>
std::pair<bool, std::string> outcomeOf(const InjectResult& result) {
  return {isReached(result.outcome), outcomeText(result.outcome, result.reason, result.punctures, result.volume)};
}

InjectionBox::InjectionBox(std::function<SessionView()> newest, QWidget* parent)
    : QWidget(parent), newest_(std::move(newest)), report_(new LampRow("", 2, this)) {
  QGridLayout* layout = boxLayout(this, "Automatic injection");
  start_ = std::make_unique<OfferRow>("Start", 2, this, layout, 1, [this] { press(); });
  cancel_ = new OfferButton("Cancel", this, [this] {
    if (runner_ && running_) runner_->cancel();
  });
  cancel_->setFixedSize(86, 28);
  cancel_->setToolTip("Ends a pulse and withdraws the needle");
  layout->addWidget(cancel_, 2, 0);
  layout->addWidget(report_, 2, 1);
}

InjectionBox::~InjectionBox() = default;

void InjectionBox::start(Bus& bus) {
  if (bus_) return;
  bus_ = &bus;
  const auto describe = [](const InjectFeedback& at) {
    return progressText({at.state, at.layer, at.layers, at.depth, at.force, at.elapsed});
  };
  runner_ = std::make_unique<Runner>(
      bus, "controller/inject", describe,
      [this](const std::string& text) {
        if (running_) shown_ = {Light::kYellow, text};
      },
      [this](bool success, const std::string& message) { end(success, message); });
}

void InjectionBox::end(bool success, const std::string& message) {
  running_ = false;
  shown_ = {success ? Light::kGreen : Light::kRed, message};
}

void InjectionBox::checkServer() {
  if (!running_ || runner_->there()) return;
  runner_->forget();
  end(false, "injection_controller has ended");
}

void InjectionBox::press() {
  if (!bus_) return;
  serveArrived(*bus_);
  checkServer();
  if (!offerInjection(newest_(), runner_->there(), running_).refusal.empty()) return;
  running_ = true;
  shown_ = {Light::kYellow, "begins"};
  InjectGoal goal;
  goal.configured = true;
  runner_->start(goal);
}

void InjectionBox::refresh(const SessionView& session) {
  if (!bus_) return;
  setVisible(session.settings.mode == "automatic");
  checkServer();
  start_->display(offerInjection(session, runner_->there(), running_));
  cancel_->offer(running_);
  report_->display(shown_);
}

}  // namespace microinjection
