// What is sent next, and what becomes of it without a good reply.

#include <algorithm>
#include <utility>

#include "rig/injector/serial_injector.h"

namespace microinjection {
namespace {

constexpr int kTries = 3;  // of what may be sent again

}  // namespace

void SerialInjector::giveUpPulse(const std::string& why, bool was_triggered, Refusal refusal) {
  if (!sent_pulse_) return;  // taken back meanwhile
  std::string what = "pulse " + std::to_string(sent_pulse_->id) + ": " + why;
  if (!was_triggered) {
    what += "; it was not triggered";
  } else {
    stopped_ = false;  // where pulses are timed from here, a stop does no harm, whatever the device has said
  }
  if (was_triggered && refusal == Refusal::kNo) {
    what += "; it may have been done, and is not sent again";
    unsure_until_ = last_sent_ + protocol_.asSent(*sent_pulse_).duration + protocol_.framing.quiet;
    pressureChanges();
  }
  sent_pulse_.reset();
  fail(what);
}

void SerialInjector::abort(const std::string& why, Refusal refusal) {
  const bool said_no = refusal == Refusal::kYes;
  bad_replies_ += said_no ? 0 : 1;
  ++tries_;
  const bool last = said_no || tries_ >= kTries;
  const bool was_triggered = task_ == Task::kPulse && step_ + 1 == protocol_.pulse.size();
  const Task given_up = std::exchange(task_, Task::kNone);
  if (given_up == Task::kPulse) {
    giveUpPulse(why, was_triggered, refusal);
  } else if (given_up == Task::kBegin) {
    waiting_begin_ = !last;
    if (last) tries_ = 0;  // a device that knows no such line is stopped all the same
  } else if (given_up == Task::kBalance) {
    balance_known_ = false;
    pressureChanges();
    if (last) return fail("balance pressure: " + why);
    if (!waiting_balance_) waiting_balance_ = sent_balance_;
  } else if (given_up == Task::kStop) {
    waiting_stop_ = !last;
    if (!last) return;
    stop_failed_ = time_;
    stopped_ = false;
    unsure_until_ = std::max(unsure_until_, ends_);
    fail("stop: " + why + "; the pulse may go on");
  } else if (given_up == Task::kQuery && last) {
    trouble_ = "query: " + why;
    pressure_.reset();
  }
}

void SerialInjector::talk(double time) {
  const double patience = protocol_.framing.quiet + InjectorProtocol::patience(protocol_.begin) +
                          InjectorProtocol::patience(protocol_.stop) + InjectorProtocol::patience(protocol_.balance) +
                          InjectorProtocol::patience(protocol_.pulse);
  if (waiting_pulse_ && time - waits_since_ > patience) fail("the line was not free in time");
  if (!dialogue_.free()) return;
  if (task_ != Task::kNone) putBack();
  if (task_ == Task::kNone && !next(time)) return;
  const InjectorProtocol::Exchange& exchange = exchanges(task_)[step_];
  last_sent_ = time;
  dialogue_.send(exchange.send.fill(say_), exchange.timeout, time);
}

/// Between two lines of a command: a stop does not wait for the rest, and a pulse that was taken back ends here. Begin
/// is finished first: before it a device may not know the stop.
void SerialInjector::putBack() {
  const bool taken_back = task_ == Task::kPulse && !sent_pulse_;
  if (task_ == Task::kStop || task_ == Task::kBegin || (!waiting_stop_ && !taken_back)) return;
  if (task_ == Task::kBalance) {
    balance_known_ = false;  // the device may have heard it
    if (!waiting_balance_) waiting_balance_ = sent_balance_;
  }
  sent_pulse_.reset();
  task_ = Task::kNone;
}

bool SerialInjector::begin(Task task) {
  task_ = task;
  step_ = 0;
  say_ = task == Task::kPulse ? protocol_.pulseValues(protocol_.asSent(*sent_pulse_))
                              : protocol_.balanceValues(sent_balance_);
  return true;
}

/// Begins the most urgent command; false: there is none.
bool SerialInjector::next(double time) {
  const bool holds =
      protocol_.timed && model_.reading().busy;  // a line in between would end the pulse, or delay its end
  if (std::exchange(waiting_begin_, false)) return begin(Task::kBegin);  // the line was quiet since it was opened
  if (std::exchange(waiting_stop_, false)) return begin(Task::kStop);
  if (holds || !dialogue_.quiet(time)) return false;
  if (waiting_balance_) {  // before the pulse, which returns to it
    sent_balance_ = protocol_.balanceAsSent(*std::exchange(waiting_balance_, std::nullopt));
    return begin(Task::kBalance);
  }
  if (waiting_pulse_ && (stopped_ || !protocol_.timed)) {
    sent_pulse_ = std::exchange(waiting_pulse_, std::nullopt);
    return begin(Task::kPulse);
  }
  if (protocol_.query.empty() || time - asked_ < protocol_.query_period) return false;
  asked_ = time;
  return begin(Task::kQuery);
}

}  // namespace microinjection
