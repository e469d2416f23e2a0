// SerialInjector: sends the next line, and handles exchanges without a valid reply.

#include <algorithm>
#include <utility>

#include "rig/injector/protocol_placeholders.h"
#include "rig/injector/serial_injector.h"

namespace microinjection {

void SerialInjector::giveUpPulse(const std::string& reason, bool was_triggered, Refusal refusal) {
  if (!sent_pulse_) return;  // cancelled meanwhile
  std::string what = "pulse " + std::to_string(sent_pulse_->id) + ": " + reason;
  if (!was_triggered) {
    what += "; it was not triggered";
  } else {
    stopped_ = false;  // if this driver times the pulses, a stop does no harm, whatever the reply was
  }
  if (was_triggered && refusal == Refusal::kNo) {
    what += "; it may have been done, and is not sent again; the volume leaves it out";
    unanswered_ = protocol_.asSent(*sent_pulse_).duration + protocol_.framing.quiet;
    unconfirmed_until_ = last_sent_ + *unanswered_;
    pressureChanges();
  }
  sent_pulse_.reset();
  fail(what);
}

void SerialInjector::giveUpVerification(const std::string& reason) {
  if (!unverified_) return;
  volume_ = unverified_->volume;
  const std::string what = "pulse " + std::to_string(unverified_->pulse.id) + ": " + reason;
  given_up_ = unverified_->pulse.id;
  unconfirmed_until_ = std::max(unconfirmed_until_, unverified_->longest);
  unverified_.reset();
  waiting_verify_ = false;
  fail(what + "; what it has injected is unknown, and the volume leaves it out");
}

void SerialInjector::abort(const std::string& reason, Refusal refusal) {
  const bool refused = refusal == Refusal::kYes;
  bad_replies_ += refused ? 0 : 1;
  const int tries = task_ == Task::kQuery ? ++query_tries_ : ++tries_;
  const bool last = refused || tries >= kTries;
  const bool was_triggered = task_ == Task::kPulse && step_ + 1 == protocol_.pulse.size();
  const Task given_up = std::exchange(task_, Task::kNone);
  if (given_up == Task::kPulse) {
    giveUpPulse(reason, was_triggered, refusal);
  } else if (given_up == Task::kVerify) {
    waiting_verify_ = !last && unverified_;
    if (!last) return;
    tries_ = 0;
    giveUpVerification("afterwards " + reason);
  } else if (given_up == Task::kBegin) {
    waiting_begin_ = !last;
    if (last) tries_ = 0;  // a device without this command is stopped all the same
  } else if (given_up == Task::kBalance) {
    balance_confirmed_ = false;
    pressureChanges();
    if (last) return fail("balance pressure: " + reason);
    if (!waiting_balance_) waiting_balance_ = sent_balance_;
  } else if (given_up == Task::kStop) {
    waiting_stop_ = !last;
    if (!last) return;
    stop_failed_ = time_;
    pressureChanges();  // the device may have stopped, and only its reply was lost
    stopped_ = false;
    unconfirmed_until_ = std::max(unconfirmed_until_, ends_);
    fail("stop: " + reason + "; the pulse may go on");
  } else if (given_up == Task::kQuery) {
    if (protocol_.query.front().confirm == kLine) {  // it may have been reset, and cannot tell
      balance_confirmed_ = false;
      if (!waiting_balance_) waiting_balance_ = sent_balance_;
      pressureChanges();
    }
    if (!last) return;
    error_text_ = "query: " + reason;
    pressure_.reset();
  }
}

void SerialInjector::sendNext(double time) {
  const double timeout = protocol_.framing.quiet + InjectorProtocol::totalTimeout(protocol_.begin) +
                         InjectorProtocol::totalTimeout(protocol_.stop) +
                         InjectorProtocol::totalTimeout(protocol_.balance) +
                         InjectorProtocol::totalTimeout(protocol_.pulse);
  if (waiting_pulse_ && time - pulse_wait_start_ > timeout) fail("the line was not free in time");
  if (!dialogue_.free()) return;
  if (task_ != Task::kNone) putBack();
  if (task_ == Task::kNone && !next(time)) return;
  const InjectorProtocol::Exchange& exchange = exchanges(task_)[step_];
  last_sent_ = time;
  values_[kCount] = count_ = count_ % (sizeof kCounts - 2) + 1;
  if (unanswered_) unconfirmed_until_ = time + *unanswered_;  // if it waits for its end, this line has it
  dialogue_.send(exchange.send.fill(values_), exchange.timeout, time);
}

/// Between two lines of a command: a stop does not wait for the rest, and a cancelled pulse ends
/// here. `begin` is completed first, since the device may not accept a stop before it.
void SerialInjector::putBack() {
  const bool taken_back = task_ == Task::kPulse && !sent_pulse_;
  if (task_ == Task::kStop || task_ == Task::kBegin || (!waiting_stop_ && !taken_back)) return;
  if (task_ == Task::kBalance) {
    balance_confirmed_ = false;  // the device may have received it
    if (!waiting_balance_) waiting_balance_ = sent_balance_;
  }
  if (task_ == Task::kVerify) waiting_verify_ = unverified_.has_value();
  sent_pulse_.reset();
  task_ = Task::kNone;
}

bool SerialInjector::begin(Task task) {
  task_ = task;
  step_ = 0;
  values_ = task == Task::kPulse    ? protocol_.pulseValues(protocol_.asSent(*sent_pulse_))
            : task == Task::kVerify ? protocol_.pulseValues(unverified_->pulse)
                                    : protocol_.balanceValues(sent_balance_);
  return true;
}

/// Begins the most urgent command. Returns false if there is none.
bool SerialInjector::next(double time) {
  const bool holds =
      protocol_.timed && model_.reading().busy;  // a line in between would end the pulse, or delay its end
  if (std::exchange(waiting_begin_, false)) return begin(Task::kBegin);  // the line has been quiet since it was opened
  if (std::exchange(waiting_stop_, false)) return begin(Task::kStop);
  if (holds || !dialogue_.quiet(time)) return false;
  if (std::exchange(waiting_verify_, false) && unverified_) return begin(Task::kVerify);
  if (waiting_balance_) {  // precedes the pulse, which returns to it
    sent_balance_ = protocol_.balanceAsSent(*std::exchange(waiting_balance_, std::nullopt));
    return begin(Task::kBalance);
  }
  if (waiting_pulse_ && (stopped_ || !protocol_.timed)) {
    sent_pulse_ = std::exchange(waiting_pulse_, std::nullopt);
    return begin(Task::kPulse);
  }
  if (protocol_.query.empty() || time - last_query_ < protocol_.query_period) return false;
  last_query_ = time;
  return begin(Task::kQuery);
}

}  // namespace microinjection
