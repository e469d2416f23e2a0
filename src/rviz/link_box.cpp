#include "rviz/link_box.h"

#include <QGridLayout>
#include <string>

#include "rviz/offer_row.h"

namespace microinjection {

LinkBox::LinkBox(QWidget* parent) : QWidget(parent) {
  auto* layout = new QGridLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setColumnStretch(1, 1);
  unplug_ = std::make_unique<OfferRow>("Unplug", 1, this, layout, 0, [this] { plug(false); });
  plug_in_ = std::make_unique<OfferRow>("Plug in", 1, this, layout, 1, [this] { plug(true); });
  hide();
}

LinkBox::~LinkBox() = default;

void LinkBox::start() {
  if (node_) return;
  node_.emplace();
  node_->setCallbackQueue(&queue_);
  const auto counts = [this](int change) {
    return [this, change](const ros::SingleSubscriberPublisher& subscriber) {
      if (subscriber.getSubscriberName() == "/link_emulator") emulators_ += change;
    };
  };
  publisher_ = node_->advertise<std_msgs::Bool>("link/plugged", 1, counts(1), counts(-1));
  subscriber_ = node_->subscribe<std_msgs::Bool>("link/plugged", 1,
                                                 boost::function<void(const std_msgs::Bool::ConstPtr&)>(
                                                     [this](const auto& message) { plugged_ = message->data; }));
}

void LinkBox::plug(bool in) {
  std_msgs::Bool message;
  message.data = static_cast<std_msgs::Bool::_data_type>(in);
  publisher_.publish(message);
}

void LinkBox::refresh() {
  if (!node_) return;
  queue_.callAvailable(ros::WallDuration(0));
  if (emulators_ == 0) plugged_.reset();  // the next one starts plugged in
  setVisible(emulators_ > 0);
  const bool can_unplug = plugged_.value_or(true), can_plug_in = !plugged_.value_or(false);
  unplug_->display(can_unplug, can_unplug ? "the emulated network's cable" : "the network is unplugged");
  plug_in_->display(can_plug_in, can_plug_in ? "the emulated network's cable" : "the network is plugged in");
}

}  // namespace microinjection
