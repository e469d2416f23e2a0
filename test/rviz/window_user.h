#pragma once

#include <QApplication>
#include <QLabel>
#include <QPushButton>
#include <QTest>
#include <QWidget>
#include <cstdlib>
#include <map>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

#include "rviz/colours.h"
#include "rviz/elided_label.h"
#include "rviz/guard_row.h"
#include "rviz/lamp_row.h"

namespace microinjection {

/// Starts Qt, once, without a screen. No click waits for whether it becomes a double click: that would be wall time.
inline void startQt() {
  static QApplication* const application = [] {
    setenv("QT_QPA_PLATFORM", "offscreen", 1);
    static int count = 1;
    static char name[] = "rviz_test";
    static char* words[] = {name, nullptr};
    auto* const made = new QApplication(count, words);
    made->setDoubleClickInterval(0);
    return made;
  }();
  application->processEvents();
}

inline const char* toText(Light light) {
  constexpr const char* kNames[] = {"grey", "green", "yellow", "red"};
  return kNames[static_cast<int>(light)];
}

/// Somebody before a window, who knows only what is drawn there, and has a mouse.
class WindowUser {
 public:
  explicit WindowUser(QWidget& window) : window_(window) {}

  /// A button that is to be seen, by its label or the first words of it. `number`: of those with the same label.
  QPushButton& button(const std::string& label, std::size_t number = 0) const {
    std::vector<QPushButton*> found;
    for (QPushButton* button : shown<QPushButton>()) {
      const QString text = button->text(), wanted = QString::fromStdString(label);
      if (text == wanted || text.startsWith(wanted + "  ")) found.push_back(button);
    }
    if (found.size() <= number) throw std::runtime_error("no button " + label + " is shown");
    return *found[number];
  }
  bool shows(const std::string& label) const {
    for (const QPushButton* button : shown<QPushButton>()) {
      if (button->text() == QString::fromStdString(label)) return true;
    }
    return false;
  }
  /// Whether it has the colour of a button that is offered.
  bool offered(const std::string& label, std::size_t number = 0) const { return isBlue(button(label, number)); }
  /// The labels of all buttons that are offered.
  std::set<std::string> allOffered() const {
    std::set<std::string> labels;
    for (QPushButton* button : shown<QPushButton>()) {
      if (isBlue(*button)) labels.insert(button->text().toStdString());
    }
    return labels;
  }
  /// What is written right of a button.
  std::string beside(const std::string& label, std::size_t number = 0) const {
    const QPushButton& at = button(label, number);
    const ElidedLabel* nearest = nullptr;
    for (const ElidedLabel* text : shown<ElidedLabel>()) {
      if (text->parentWidget() != at.parentWidget() || text->x() < at.geometry().right()) continue;
      if (text->geometry().top() > at.geometry().center().y() || text->geometry().bottom() < at.geometry().center().y())
        continue;
      if (!nearest || text->x() < nearest->x()) nearest = text;
    }
    return nearest ? nearest->toolTip().toStdString() : "";
  }

  /// The mouse goes there: to what is drawn on top.
  void press(const QPoint& place) {
    pressed_ = window_.childAt(place);
    if (!pressed_) throw std::runtime_error("the mouse is on nothing");
    QTest::mousePress(pressed_, Qt::LeftButton, {}, pressed_->mapFrom(&window_, place));
  }
  /// The mouse is where it was pressed.
  void release(const QPoint& place) {
    QTest::mouseRelease(pressed_, Qt::LeftButton, {}, pressed_->mapFrom(&window_, place));
  }
  void click(const QPoint& place) {
    press(place);
    release(place);
  }
  void click(const std::string& label, std::size_t number = 0) { click(placeOf(button(label, number))); }
  QPoint place(const std::string& label, std::size_t number = 0) const { return placeOf(button(label, number)); }
  QPoint placeOf(const QWidget& widget) const { return widget.mapTo(&window_, widget.rect().center()); }

  /// {name: colour} of the lamps that have a name.
  std::map<std::string, std::string> lamps() const {
    std::map<std::string, std::string> colours;
    for (LampRow* row : shown<LampRow>()) {
      if (const std::string name = nameOf(*row); !name.empty()) colours[name] = colourOfLamp(*row);
    }
    return colours;
  }
  std::set<std::string> lamps(const std::string& colour) const {
    std::set<std::string> names;
    for (const auto& [name, its] : lamps()) {
      if (its == colour) names.insert(name);
    }
    return names;
  }
  /// {colour, text} of a lamp without a name, by the part of the window that has it.
  static std::pair<std::string, std::string> lampIn(const QWidget& part) {
    for (LampRow* row : inside<LampRow>(part)) {
      if (nameOf(*row).empty() && row->isVisible()) return {colourOfLamp(*row), textOf(*row)};
    }
    throw std::runtime_error("no lamp is shown");
  }
  std::string textOfLamp(const std::string& name) const {
    for (LampRow* row : shown<LampRow>()) {
      if (nameOf(*row) == name) return textOf(*row);
    }
    throw std::runtime_error("no lamp " + name + " is shown");
  }
  /// The colour with which the bar of a guard begins; "empty": nothing of it is filled.
  std::string guard(const std::string& name) const {
    for (GuardRow* row : shown<GuardRow>()) {
      if (!row->toolTip().startsWith(QString::fromStdString(name + " "))) continue;
      const QImage picture = row->grab().toImage();
      for (int x = 0; x < picture.width(); ++x) {
        const QRgb pixel = picture.pixel(x, row->height() / 2);
        if (pixel == kRefusedColour) return "empty";
        for (const Light light : kLights) {
          if (pixel == colourOf(light).rgb()) return toText(light);
        }
      }
    }
    throw std::runtime_error("no guard " + name + " is shown");
  }

  /// All parts of a kind that are to be seen.
  template <typename Part>
  std::vector<Part*> shown() const {
    std::vector<Part*> parts;
    for (Part* part : inside<Part>(window_)) {
      if (part->isVisible()) parts.push_back(part);
    }
    return parts;
  }

 private:
  static constexpr Light kLights[] = {Light::kGreen, Light::kYellow, Light::kRed, Light::kGrey};

  /// Qt's own findChildren knows only classes with Q_OBJECT.
  template <typename Part>
  static std::vector<Part*> inside(const QWidget& whole) {
    std::vector<Part*> parts;
    for (QWidget* child : whole.findChildren<QWidget*>()) {
      if (auto* const part = dynamic_cast<Part*>(child)) parts.push_back(part);
    }
    return parts;
  }
  static bool isBlue(QPushButton& button) {
    return button.grab().toImage().pixel(4, button.height() / 2) == kOfferedColour;
  }
  static std::string nameOf(const LampRow& row) {
    const auto* const name = row.findChild<QLabel*>();
    return name ? name->text().toStdString() : "";
  }
  static std::string textOf(const LampRow& row) { return inside<ElidedLabel>(row).at(0)->toolTip().toStdString(); }
  static std::string colourOfLamp(LampRow& row) {
    for (QWidget* part : inside<QWidget>(row)) {
      if (part->width() != part->height()) continue;
      const QRgb pixel = part->grab().toImage().pixel(part->width() / 2, part->height() / 2);
      for (const Light light : kLights) {
        if (pixel == colourOf(light).rgb()) return toText(light);
      }
    }
    throw std::runtime_error("a lamp has no colour");
  }

  QWidget& window_;
  QWidget* pressed_ = nullptr;
};

}  // namespace microinjection
