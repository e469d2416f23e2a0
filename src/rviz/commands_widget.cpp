#include "rviz/commands_widget.h"

#include <QGridLayout>
#include <QShortcut>
#include <utility>

#include "rviz/colours.h"

namespace microinjection {
namespace {

constexpr char kStopStyle[] = "font-weight: bold; font-size: 20px;";

}  // namespace

CommandsWidget::CommandsWidget(std::function<SessionView()> newest, Send send, QWidget* parent)
    : QWidget(parent), newest_(std::move(newest)), send_(std::move(send)) {
  auto* layout = new QGridLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setHorizontalSpacing(8);
  layout->setVerticalSpacing(4);
  layout->setColumnStretch(1, 1);
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    Row& row = rows_[i];
    const bool is_stop = kConsoleCommands[i] == ConsoleCommand::kStop;
    row.button = new QPushButton(this);
    // A focused button would take the space bar.
    row.button->setFocusPolicy(Qt::NoFocus);
    row.text = new ElidedLabel(is_stop ? 1 : 2, this);
    const int line = static_cast<int>(i);
    layout->addWidget(row.button, line, 0, 1, is_stop ? 2 : 1);
    layout->addWidget(row.text, is_stop ? line + 1 : line, is_stop ? 0 : 1, 1, is_stop ? 2 : 1);
    if (is_stop) {
      row.button->setFixedHeight(44);
    } else {
      row.button->setFixedSize(86, 28);
    }
    const auto pressed = [this, i] { press(i); };
    if (is_stop) {
      // At the press, not at the release: a stop must not wait for the finger.
      QObject::connect(row.button, &QPushButton::pressed, this, pressed);
    } else {
      QObject::connect(row.button, &QPushButton::clicked, this, pressed);
    }
  }
  // Buttons that stay where they are, whatever appears beside them.
  layout->setRowStretch(layout->rowCount(), 1);
  auto* space = new QShortcut(QKeySequence(Qt::Key_Space), this);
  space->setContext(Qt::ApplicationShortcut);
  // A second press means disable, which a key that is held down must not.
  space->setAutoRepeat(false);
  const auto stop = [this] { press(rows_.size() - 1); };
  QObject::connect(space, &QShortcut::activated, this, stop);
  QObject::connect(space, &QShortcut::activatedAmbiguously, this, stop);
  display({});
}

void CommandsWidget::press(std::size_t index) {
  // What is displayed may be older: a stop during a pulse must not be that of the state before.
  const SessionView session = newest_();
  const CommandOffer offered = offer(kConsoleCommands[index], session);
  if (offered.refusal.empty()) send_(kConsoleCommands[index], offered.command);
  // A refused press shows its reason at once.
  display(session);
}

void CommandsWidget::display(const SessionView& session) {
  for (std::size_t i = 0; i < rows_.size(); ++i) {
    const bool visible = session.settings.has_holder || !needsHolder(kConsoleCommands[i]);
    rows_[i].button->setVisible(visible);
    rows_[i].text->setVisible(visible);
    display(rows_[i], offer(kConsoleCommands[i], session), kConsoleCommands[i] == ConsoleCommand::kStop);
  }
}

void CommandsWidget::display(Row& row, const CommandOffer& offer, bool is_stop) {
  // Qt forgets a press whose button is greyed before the release, and the label must be the one that was pressed.
  if (row.button->isDown()) return;
  const bool first = row.shown.label.empty();
  const bool enabled = offer.refusal.empty();
  if (first || enabled != row.shown.refusal.empty()) {
    row.button->setEnabled(enabled);
    row.button->setStyleSheet(is_stop ? buttonStyle(kStopColour, 0xffffffff, kStopStyle) : offerStyle(enabled));
    row.text->setColour(enabled ? palette().color(QPalette::WindowText) : QColor(kMutedColour));
  }
  row.button->setText(QString::fromStdString(is_stop ? offer.label + "   (space bar)" : offer.label));
  const QString text = QString::fromStdString(enabled ? offer.effect : offer.refusal);
  row.text->setText(text);
  row.shown = offer;
}

}  // namespace microinjection
