#pragma once

#include <QWidget>

namespace microinjection {

/// A text of at most `lines` lines that ends with "..." where it does not fit. Its tooltip has the
/// whole text. Its size does not depend on the text, so that nothing moves when the text changes.
class ElidedLabel : public QWidget {
 public:
  explicit ElidedLabel(int lines, QWidget* parent = nullptr);
  void setText(const QString& text);
  void setColour(const QColor& colour);
  QSize sizeHint() const override;
  QSize minimumSizeHint() const override { return sizeHint(); }

 protected:
  void paintEvent(QPaintEvent* event) override;

 private:
  int lines_;
  QString text_;
  QColor colour_;
};

}  // namespace microinjection
