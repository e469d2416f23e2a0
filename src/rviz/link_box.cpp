#include "rviz/link_box.h"

#include <QGridLayout>

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

void LinkBox::start(Bus& bus) {
  if (publisher_) return;
  publisher_ = bus.advertise<std_msgs::Bool>("link/plugged", 1);
  subscription_ = bus.subscribe<std_msgs::Bool>("link/plugged", 1,
                                                [this](const auto& delivery) { plugged_ = delivery.message->data; });
}

void LinkBox::plug(bool in) {
  std_msgs::Bool message;
  message.data = static_cast<std_msgs::Bool::_data_type>(in);
  publisher_.publish(message);
}

void LinkBox::refresh() {
  if (!publisher_) return;
  const bool emulated = publisher_.isSubscribedBy("/link_emulator");
  if (!emulated) plugged_.reset();  // the next one starts plugged in
  setVisible(emulated);
  const bool can_unplug = plugged_.value_or(true), can_plug_in = !plugged_.value_or(false);
  unplug_->display(can_unplug, can_unplug ? "the emulated network's cable" : "the network is unplugged");
  plug_in_->display(can_plug_in, can_plug_in ? "the emulated network's cable" : "the network is plugged in");
}

}  // namespace microinjection
