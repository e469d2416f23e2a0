#include "nodes/notebook_node.h"

#include <ros/console.h>

#include <algorithm>

#include "base/atomic_file.h"
#include "nodes/display/cell_state_reader.h"
#include "nodes/recording/session_files.h"
#include "nodes/runtime/message_guard.h"
#include "nodes/runtime/node_parameters.h"

namespace microinjection {
namespace {

constexpr int kNotebookQueue = 50;
constexpr double kNotebookReportPeriod = 0.2;  // s of steady time

/// Idle and approach are before the touch; the needle may leave the cell in any other state.
bool inCell(const std::string& state) {
  return state == "contact" || state == "indent" || state == "aspirate" || state == "punctured" || state == "inject";
}

std::string folderOf(const std::string& path) {
  const auto end = path.rfind('/');
  return end == std::string::npos ? "." : path.substr(0, std::max<std::size_t>(end, 1));
}

}  // namespace

const char* const NotebookNode::kHelp =
    "notebook: a row of a CSV file for each cell that the needle has touched.\n"
    "In: /controller/injection_state /cell/estimate /cell/puncture_score /cell/state.\n"
    "Parameters:\n"
    "  ~file  path of the CSV file, required; an existing notebook is continued\n"
    "  ~cell  name of the cell in its rows\n";

NotebookNode::NotebookNode(Bus& bus) : bus_(bus), diagnostics_(bus) {
  ConfigReader reader = parameterReader(bus);
  reader.path("file", file_, ConfigReader::kRequired);
  reader.text("cell", cell_);
  reader.finish();
  requireWritableFolder(folderOf(file_));
  using namespace cell_microinjection;
  subscriptions_ = {
      subscribeGuarded<InjectionStatus>(bus, "controller/injection_state", kNotebookQueue,
                                        [this](const InjectionStatus& message, const auto&) { onStatus(message); }),
      subscribeGuarded<CellEstimate>(bus, "cell/estimate", kNotebookQueue,
                                     [this](const CellEstimate& message, const auto&) { onEstimate(message); }),
      subscribeGuarded<PunctureScore>(bus, "cell/puncture_score", kNotebookQueue,
                                      [this](const PunctureScore& message, const auto&) { onScore(message); }),
      subscribeGuarded<CellState>(bus, "cell/state", 1,
                                  [this](const CellState& message, const auto&) { onCell(message); })};
  diagnostics_.add("notebook", [this](auto& status) { report(status); });
  timer_ = bus.timer(kNotebookReportPeriod, [this] { diagnostics_.update(); });
  bus.onEnd([this] { finish(); });
}

/// A session that ends with the needle in a cell has a row of it, too.
void NotebookNode::finish() {
  if (!touched_) return;
  last_.outcome = "session_ended";
  write(last_);
}

void NotebookNode::onStatus(const cell_microinjection::InjectionStatus& message) {
  if (inCell(message.state)) touched_ = true;
  if (!touched_) return;
  last_ = message;
  entry_.peak_force = std::max(entry_.peak_force, message.force);
  entry_.deepest = std::max(entry_.deepest, message.depth);
  entry_.punctures = std::max(entry_.punctures, message.punctures);
  entry_.volume = message.volume;
  if (message.state == "idle" || message.state == "fault") write(message);
}

void NotebookNode::onEstimate(const cell_microinjection::CellEstimate& message) {
  if (message.verdict == "prior" || message.samples == 0) return;  // the needle is out of the cell
  entry_.modulus = NotebookEntry::Estimate{message.modulus, message.modulus_low, message.modulus_high};
  entry_.verdict = message.verdict;
}

void NotebookNode::onScore(const cell_microinjection::PunctureScore& message) {
  entry_.puncture_depth = message.depth;
  entry_.puncture_force = message.force;
  const auto& expected = message.predicted;
  if (!(expected.depth > 0)) return;
  entry_.expected_depth = NotebookEntry::Estimate{expected.depth, expected.depth_low, expected.depth_high};
  entry_.expected_force = NotebookEntry::Estimate{expected.force, expected.force_low, expected.force_high};
}

void NotebookNode::onCell(const cell_microinjection::CellState& message) {
  entry_.diameter = cellParameter(message, "diameter");
}

void NotebookNode::write(const cell_microinjection::InjectionStatus& message) {
  entry_.time = localTime(bus_);
  entry_.cell = cell_;
  entry_.outcome = message.outcome == "none" ? "by_hand" : message.outcome;
  entry_.reason = message.reason;
  try {
    appendToNotebook(file_, entry_);
    ++written_;
    error_.clear();
  } catch (const std::exception& error) {
    error_ = error.what();
    ROS_ERROR_STREAM("the cell is not in the notebook: " << error_);
  }
  NotebookEntry next;
  next.diameter = entry_.diameter;
  entry_ = next;
  touched_ = false;
}

void NotebookNode::report(diagnostic_updater::DiagnosticStatusWrapper& status) const {
  if (error_.empty()) {
    status.summary(diagnostic_msgs::DiagnosticStatus::OK, touched_ ? "the needle is in a cell" : "waits for a cell");
  } else {
    status.summary(diagnostic_msgs::DiagnosticStatus::ERROR, error_);
  }
  status.add("rows", written_);
}

}  // namespace microinjection
