#pragma once

#include <QPushButton>
#include <QWidget>
#include <array>
#include <functional>
#include <string>

#include "operation/console/console_commands.h"
#include "rviz/elided_label.h"

namespace microinjection {

/// The buttons, each with its effect or the reason why it is greyed, and the stop button, which the
/// space bar presses wherever the focus is in the window. In a text field the space bar writes a
/// space.
class CommandsWidget : public QWidget {
 public:
  /// `newest`: gives the session at the moment of a press; `send`: called with the command of a
  /// pressed button.
  CommandsWidget(std::function<SessionView()> newest, std::function<void(const std::string&)> send,
                 QWidget* parent = nullptr);
  void display(const SessionView& session);

 private:
  struct Row {
    QPushButton* button = nullptr;
    ElidedLabel* text = nullptr;
    CommandOffer shown;
  };
  void press(std::size_t index);
  void display(Row& row, const CommandOffer& offer, bool is_stop);

  std::function<SessionView()> newest_;
  std::function<void(const std::string&)> send_;
  std::array<Row, kConsoleCommands.size()> rows_;
};

}  // namespace microinjection
