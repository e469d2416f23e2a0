#include "rviz/jog_row.h"

#include <QHBoxLayout>
#include <QLabel>

#include "rviz/colours.h"

namespace microinjection {

JogRow::JogRow(const QString& name, const std::vector<const char*>& buttons, const std::vector<double>& steps,
               const Pressed& pressed, QWidget* parent)
    : QWidget(parent), steps_(new QComboBox(this)), text_(new ElidedLabel(1, this)) {
  auto* layout = new QHBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(4);
  layout->addWidget(new QLabel(name, this));
  for (std::size_t i = 0; i < buttons.size(); ++i) {
    auto* button = new OfferButton(buttons[i], this, [pressed, i] { pressed(i); });
    button->setFixedSize(38, 26);
    buttons_.push_back(button);
    layout->addWidget(button);
  }
  for (const double step : steps) steps_->addItem(QString::number(1e6 * step) + " um", step);
  steps_->setCurrentIndex(1);
  // With the focus, it would take the space bar.
  steps_->setFocusPolicy(Qt::NoFocus);
  steps_->setToolTip("Length of a step");
  layout->addWidget(steps_);
  layout->addWidget(text_, 1);
}

double JogRow::step() const { return steps_->currentData().toDouble(); }

void JogRow::setText(const std::string& text, bool muted) {
  text_->setColour(muted ? QColor(kMutedColour) : palette().color(QPalette::WindowText));
  text_->setText(QString::fromStdString(text));
}

}  // namespace microinjection
