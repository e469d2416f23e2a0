#pragma once

#include <rviz/panel.h>

#include <memory>

#include "nodes/bus/bus.h"

class QTimer;

namespace microinjection {

class MicroscopeWidget;

/// The microscope's image in a panel of rviz, below the scene. The panel appears with the first node that publishes
/// images: a session without a camera has room for the scene.
///
/// Its configuration: Share, of the window's height.
class MicroscopePanel : public rviz::Panel {
  Q_OBJECT
 public:
  explicit MicroscopePanel(QWidget* parent = nullptr);
  ~MicroscopePanel() override;
  void onInitialize() override;
  void load(const rviz::Config& config) override;
  void save(rviz::Config config) const override;

 private:
  void appear();

  std::shared_ptr<Bus> bus_;
  MicroscopeWidget* microscope_;
  QTimer* timer_;
  float share_ = 0.5F;
};

}  // namespace microinjection
