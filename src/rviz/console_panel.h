#pragma once

#include <rviz/panel.h>

#include <memory>

#include "nodes/bus/bus.h"

class QTimer;

namespace microinjection {

class ConsoleWidget;

/// The operator's console as a panel of rviz. All its work runs in the timer of rviz's GUI thread, which is why a
/// command waits for a frame that rviz draws.
///
/// Its configuration: Parts, the words of ConsoleParts.
class ConsolePanel : public rviz::Panel {
  Q_OBJECT
 public:
  explicit ConsolePanel(QWidget* parent = nullptr);
  ~ConsolePanel() override;
  void onInitialize() override;
  void load(const rviz::Config& config) override;
  void save(rviz::Config config) const override;
  QSize sizeHint() const override;

 private:
  std::shared_ptr<Bus> bus_;
  ConsoleWidget* console_;
  QTimer* timer_;
};

}  // namespace microinjection
