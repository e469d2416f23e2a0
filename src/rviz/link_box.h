#pragma once

#include <std_msgs/Bool.h>

#include <QWidget>
#include <memory>
#include <optional>

#include "nodes/bus/bus.h"

namespace microinjection {

class OfferRow;

/// Pulls the cable of an emulated network between hand and rig, and plugs it in again. Hidden without
/// such a network.
///
/// In, out: /link/plugged
class LinkBox : public QWidget {
 public:
  explicit LinkBox(QWidget* parent = nullptr);
  ~LinkBox() override;
  void start(Bus& bus);
  /// Shows whether there is such a network, and whether it is plugged in.
  void refresh();

 private:
  void plug(bool in);

  std::unique_ptr<OfferRow> unplug_, plug_in_;
  std::optional<bool> plugged_;  ///< as the last message said; before the first it is not known
  Publisher<std_msgs::Bool> publisher_;
  Subscription subscription_;
};

}  // namespace microinjection
