#include "rviz/hand_box.h"

#include <QLabel>
#include <QVBoxLayout>

#include "rviz/elided_label.h"
#include "rviz/lamp_row.h"
#include "rviz/link_box.h"
#include "rviz/session_parameters.h"

namespace microinjection {
namespace {

constexpr double kBridgeSilence = 3;  // s, of haptic_bridge, whose state comes with each change and each second

bool firstButton(const sensor_msgs::Joy& message) { return !message.buttons.empty() && message.buttons[0] != 0; }

}  // namespace

HandBox::HandBox(QWidget* parent)
    : QWidget(parent),
      follows_(new LampRow("Needle", 2, this)),
      clutch_(new LampRow("Clutch", 1, this)),
      present_(new LampRow("Switch", 1, this)),
      position_(new ElidedLabel(1, this)),
      force_(new ElidedLabel(1, this)),
      link_(new LinkBox(this)) {
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(4);
  layout->addWidget(new QLabel("<b>Hand</b>", this));
  for (QWidget* row : {static_cast<QWidget*>(follows_), static_cast<QWidget*>(clutch_), static_cast<QWidget*>(present_),
                       static_cast<QWidget*>(position_), static_cast<QWidget*>(force_), static_cast<QWidget*>(link_)}) {
    layout->addWidget(row);
  }
}

void HandBox::start(Bus& bus) {
  if (bus_) return;
  bus_ = &bus;
  link_->start(bus);
  loop_ = bus.subscribe<cell_microinjection::LoopState>("haptic/loop_state", 1, [this](const auto& delivery) {
    const double now = bus_->steady().toSec();
    if (!heard_at_ || now - *heard_at_ > kBridgeSilence) readSettings();
    heard_at_ = now;
    hand_.has_bridge = true;
    hand_.hold_reason = delivery.message->follows ? "" : delivery.message->hold_reason;
  });
  clutches_ = bus.subscribe<sensor_msgs::Joy>(
      "haptic/clutch", 1, [this](const auto& delivery) { hand_.clutch = firstButton(*delivery.message); });
  presences_ = bus.subscribe<sensor_msgs::Joy>(
      "haptic/operator_present", 1, [this](const auto& delivery) { hand_.present = firstButton(*delivery.message); });
}

/// The parameters are set before the bridge starts. To read them waits for the master, which is why
/// it is done only when a bridge appears.
void HandBox::readSettings() {
  HandSettings& settings = hand_.settings;
  settings = {};
  SessionParameters parameters(*bus_, "/haptic_bridge");
  settings.mode = parameters.text("mode");
  settings.force_source = parameters.text("force_source");
  settings.position_scale = parameters.number("position_scale");
  settings.rate_gain = parameters.number("rate_mode/gain");
  settings.force_gain = parameters.number("force_gain");
  settings.error = parameters.error();
}

void HandBox::refresh() {
  if (!bus_) return;
  HandView shown = hand_;
  if (!heard_at_ || bus_->steady().toSec() - *heard_at_ > kBridgeSilence) shown.hold_reason.reset();
  follows_->display(followsLamp(shown));
  clutch_->display(clutchLamp(shown));
  present_->display(presentLamp(shown));
  position_->setText(QString::fromStdString(positionScaleText(shown.settings)));
  force_->setText(QString::fromStdString(forceScaleText(shown.settings)));
  link_->refresh();
}

}  // namespace microinjection
