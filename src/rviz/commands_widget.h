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
/// space bar presses wherever the focus is in the window. In a text field, but not in a field
/// for a number, the space bar writes a space.
class CommandsWidget : public QWidget {
 public:
  /// Called with the button that was pressed and its command.
  using Send = std::function<void(ConsoleCommand button, const std::string& command)>;

  /// `newest`: gives the session at the moment of a press.
  CommandsWidget(std::function<SessionView()> newest, Send send, QWidget* parent = nullptr);
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
  Send send_;
  std::array<Row, kConsoleCommands.size()> rows_;
};

}  // namespace microinjection
