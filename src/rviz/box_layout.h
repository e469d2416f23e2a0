#pragma once

#include <QGridLayout>
#include <QLabel>
#include <QWidget>

namespace microinjection {

/// The grid of a box of the console: a title above, buttons in the first column, what they have to say in the second.
inline QGridLayout* boxLayout(QWidget* box, const char* title) {
  auto* layout = new QGridLayout(box);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setHorizontalSpacing(8);
  layout->setVerticalSpacing(1);
  layout->setColumnStretch(1, 1);
  layout->addWidget(new QLabel(QString("<b>%1</b>").arg(title), box), 0, 0, 1, 2);
  return layout;
}

}  // namespace microinjection
