#pragma once

#include <cell_microinjection/DisplayView.h>

#include <QCheckBox>
#include <QComboBox>
#include <QWidget>

#include "nodes/bus/bus.h"

namespace microinjection {

/// What the scene shows of the cell: the meaning of its surface's colour, and whether it is cut open.
///
/// In: /viz/view. Out: /viz/set_view
class ViewRow : public QWidget {
 public:
  explicit ViewRow(QWidget* parent = nullptr);
  /// Shows each message; grey until there is one.
  void start(Bus& bus);

 private:
  void send();

  QComboBox* colours_;
  QCheckBox* section_;
  Publisher<cell_microinjection::DisplayView> commands_;
  Subscription views_;
};

}  // namespace microinjection
