#include "rviz/view_row.h"

#include <QHBoxLayout>
#include <QLabel>

namespace microinjection {
namespace {

struct Choice {
  const char* text;
  const char* colour;  ///< of DisplayView
};
constexpr Choice kChoices[] = {{"displacement", "displacement"},
                               {"von Mises stress", "von_mises_stress"},
                               {"pressure", "pressure"},
                               {"contact pressure", "contact_pressure"}};

}  // namespace

ViewRow::ViewRow(QWidget* parent)
    : QWidget(parent), colours_(new QComboBox(this)), section_(new QCheckBox("Cut", this)) {
  auto* layout = new QHBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(6);
  layout->addWidget(new QLabel("Colour", this));
  layout->addWidget(colours_, 1);
  layout->addWidget(section_);
  for (const Choice& choice : kChoices) colours_->addItem(choice.text, QString(choice.colour));
  section_->setToolTip("The half of the cell on your side is cut away");
  // With the focus, they would take the space bar.
  colours_->setFocusPolicy(Qt::NoFocus);
  section_->setFocusPolicy(Qt::NoFocus);
  setEnabled(false);
  // Only what the operator does: what the display reports must not be sent back to it.
  QObject::connect(colours_, QOverload<int>::of(&QComboBox::activated), this, [this] { send(); });
  QObject::connect(section_, &QCheckBox::clicked, this, [this] { send(); });
}

void ViewRow::start(Bus& bus) {
  if (commands_) return;
  commands_ = bus.advertise<cell_microinjection::DisplayView>("viz/set_view", 1);
  views_ = bus.subscribe<cell_microinjection::DisplayView>("viz/view", 1, [this](const auto& delivery) {
    colours_->setCurrentIndex(colours_->findData(QString::fromStdString(delivery.message->colour)));
    section_->setChecked(delivery.message->section);
    setEnabled(true);
  });
}

void ViewRow::send() {
  cell_microinjection::DisplayView view;
  view.colour = colours_->currentData().toString().toStdString();
  view.section = section_->isChecked();
  commands_.publish(view);
}

}  // namespace microinjection
