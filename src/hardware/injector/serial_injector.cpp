#include "hardware/injector/serial_injector.h"

#include <algorithm>
#include <utility>

#include "hardware/injector/protocol_placeholders.h"

namespace microinjection {
namespace {

constexpr double kRetry = 1;      // s, between attempts to open the line, and to stop a timed pulse
constexpr double kRiseTimes = 5;  // time constants, after which 0.7 % of a pressure change remain

}  // namespace

SerialInjector::SerialInjector(std::unique_ptr<Wire> wire, const InjectorProtocol& protocol,
                               const InjectorModelConfig& model, Start start)
    : wire_(std::move(wire)),
      protocol_(protocol),
      limits_(model.limits),
      model_(model),
      dialogue_(*wire_, protocol.framing),
      commanded_(start == Start::kSendBalance),
      sent_balance_(model.balance),
      settling_(kRiseTimes * model.rise_time) {
  repeatBalance();
  if (protocol_.stop.empty()) return;
  first_stop_ = protocol_.stop.front().send.fill(protocol_.balanceValues(model.balance)) + protocol_.framing.send_end;
  wire_->setStopsApart(protocol_.stop_apart);
  wire_->setGuardedStop(first_stop_);  // a pulse must end with its node
}

SerialInjector::~SerialInjector() {
  if (first_stop_.empty() || !mayFlow() || !wire_->isOpen()) return;
  wire_->write(first_stop_, time_);
  if (protocol_.stop_apart > 0) wire_->leaveToGuard();
}

const InjectorProtocol::Exchanges& SerialInjector::exchanges(Task task) const {
  static const InjectorProtocol::Exchanges none;
  switch (task) {
    case Task::kBegin:
      return protocol_.begin;
    case Task::kPulse:
      return protocol_.pulse;
    case Task::kVerify:
      return protocol_.verify;
    case Task::kBalance:
      return protocol_.balance;
    case Task::kStop:
      return protocol_.stop;
    case Task::kQuery:
      return protocol_.query;
    default:
      return none;
  }
}

bool SerialInjector::triggered() const {
  return task_ == Task::kPulse && step_ + 1 == protocol_.pulse.size() && dialogue_.waiting();
}

/// Why the actual pressure may differ from reading(); empty if it cannot.
std::string SerialInjector::unconfirmedReason() const {
  if (protocol_.timed && !stopped_) return "the device has not confirmed that its output is off";
  if (time_ < unconfirmed_until_) return "a pulse may be under way";
  return balance_confirmed_ || !commanded_ || protocol_.balance.empty()
             ? ""
             : "the device has not accepted the balance pressure";
}

std::string SerialInjector::fault() const {
  if (!fault_.empty()) return fault_;
  if (!unguarded_.empty()) return unguarded_;
  return error_text_.empty() ? unconfirmedReason() : error_text_;
}

/// Includes a pulse whose reply failed.
bool SerialInjector::mayFlow() const {
  return triggered() || model_.reading().busy || !fault_.empty() || (protocol_.timed && !stopped_) ||
         time_ < unconfirmed_until_;
}

std::string SerialInjector::pulse(const InjectionPulse& pulse) {
  if (!fault().empty()) return fault();
  if (waiting_pulse_ || sent_pulse_ || unverified_ || model_.reading().busy) return "a pulse is under way";
  std::string out_of_limits = limits_.check(pulse);
  if (out_of_limits.empty()) out_of_limits = model_.drawRefusal(pulse.pressure);
  if (!out_of_limits.empty()) return out_of_limits;
  // Checks the rounded values: 0.4 ms is no pulse if the line has whole milliseconds.
  const std::string sent = limits_.check(protocol_.asSent(pulse));
  if (!sent.empty()) return "in the digits of the device's line, " + sent;
  const std::string refusal = protocol_.refusal(pulse);
  if (!refusal.empty()) return refusal;
  waiting_pulse_ = pulse;
  pulse_wait_start_ = time_;
  report();
  return "";
}

std::string SerialInjector::setBalance(double pressure) {
  if (!fault_.empty()) return fault_;
  std::string refusal = limits_.checkPressure("balance pressure", pressure);
  if (refusal.empty()) refusal = protocol_.balanceRefusal(pressure);
  if (refusal.empty()) refusal = model_.drawRefusal(pressure);
  if (!refusal.empty()) return refusal;
  waiting_balance_ = pressure;
  commanded_ = true;
  tries_ = 0;
  return "";
}

std::string SerialInjector::stop() {
  waiting_pulse_.reset();
  if (!triggered()) sent_pulse_.reset();  // a pulse that was only set up is dropped before its next line
  const bool can = !protocol_.stop.empty();
  if (can && mayFlow() && !stopping()) {
    waiting_stop_ = true;
    over_ = false;
    tries_ = 0;
  }
  report();
  return can || !mayFlow() ? "" : "the protocol has no line for it";
}

void SerialInjector::reset() {
  fault_.clear();
  tries_ = 0;
  if (!balance_confirmed_ && task_ != Task::kBalance) repeatBalance();
  model_.reset();
  volume_ = 0;
  if (unverified_) unverified_->volume = 0;
  report();
}

/// Sends the last balance pressure, unless another one waits or there was none.
void SerialInjector::repeatBalance() {
  if (commanded_ && !protocol_.balance.empty() && !waiting_balance_) waiting_balance_ = sent_balance_;
}

/// By the model draw_limit is reached: so that the device draws in no more it gets the rest pressure, or, in the digits
/// of its line, one above it.
void SerialInjector::endDrawing(bool by_pulse) {
  const double rest = model_.restPressure();
  double pressure = protocol_.balanceAsSent(rest);
  for (double above = 1; pressure < rest && above < 1e6; above *= 2) pressure = protocol_.balanceAsSent(rest + above);
  std::string refusal = by_pulse && protocol_.stop.empty() ? "the protocol has no line that ends a pulse" : "";
  if (by_pulse) {
    unverified_.reset();
    waiting_stop_ = refusal.empty();
    over_ = false;
  }
  if (const std::string balance = setBalance(pressure); refusal.empty()) refusal = balance;
  balance_confirmed_ = balance_confirmed_ && !refusal.empty();  // what it draws in until then is unknown
  if (!refusal.empty()) fail("draw_limit is reached, and the device draws in on: " + refusal);
}

/// A pulse counts when the model has finished it and the device has confirmed its settings.
void SerialInjector::stepModel(double time) {
  const bool unknown = !wire_->isOpen() || !error_text_.empty() || !unconfirmedReason().empty();
  const InjectorReading before = model_.reading();
  model_.step(time);
  if (model_.reading().limited && !before.limited) endDrawing(before.busy);
  if (!unknown) volume_ += model_.reading().volume - before.volume;
}

void SerialInjector::step(double time) {
  const bool unconfirmed = time_ < unconfirmed_until_;
  time_ = time;
  if (unconfirmed && time >= unconfirmed_until_) pressureChanges();  // such a pulse is over now
  checkGuard(time);  // before the model continues a pulse that the guard has ended
  const bool flowed = model_.reading().busy;
  stepModel(time);
  if (flowed && !model_.reading().busy) pressureChanges();  // ended by the device's own timer
  if (keepOpen(time)) {
    receive(time);
    keepStopped(time);
    if (wire_->isOpen()) sendNext(time);
  }
  report();
}

bool SerialInjector::keepOpen(double time) {
  if (wire_->isOpen()) return true;
  const bool flows = protocol_.timed && model_.reading().busy;
  if (task_ != Task::kNone) abort("the line broke");
  giveUpVerification("the line broke");
  if (flows && stopped_) fail("the line broke during a pulse, which may go on");
  if (waiting_pulse_) fail("the line broke");
  stopped_ = balance_confirmed_ = false;
  pressure_.reset();
  if (error_text_.empty()) error_text_ = "the line broke";
  if (time - last_attempt_ < kRetry) return false;
  last_attempt_ = time;
  error_text_ = wire_->open();
  if (!error_text_.empty()) return false;
  // The device may have been switched off.
  repeatBalance();
  waiting_begin_ = !protocol_.begin.empty();
  tries_ = query_tries_ = 0;
  dialogue_.resynchronize(time);
  return true;
}

/// The guard's stop has ended a pulse, or the guard was lost before it could. Either way the device
/// gets a stop. Its reply to the guard is ignored as a late reply.
void SerialInjector::checkGuard(double time) {
  const Wire::GuardReport guard = wire_->heartbeat();
  unguarded_ = guard.missing.empty() ? "" : "no stop guard: " + guard.missing;
  if (guard.intervention.empty()) return;
  const bool flows = mayFlow();
  if (model_.reading().busy) fail("the pulse was broken off: " + guard.intervention);
  if (model_.reading().busy) unverified_.reset();
  model_.stop();
  pressureChanges();
  if (task_ != Task::kNone) abort(guard.intervention);
  if (waiting_pulse_) fail(guard.intervention);
  if (flows && !protocol_.stop.empty()) waiting_stop_ = true;
  over_ = false;
  dialogue_.resynchronize(time);
  tries_ = 0;
}

/// For pulses timed by this driver: requests a stop when the duration is over, and while an output
/// may be on.
void SerialInjector::keepStopped(double time) {
  if (!protocol_.timed || stopping() || triggered() || time - stop_failed_ < kRetry) return;
  const bool over = model_.reading().busy && stopped_ && time >= ends_;
  if (!over && stopped_) return;
  waiting_stop_ = true;
  over_ = over;
  tries_ = 0;
}

void SerialInjector::receive(double time) {
  switch (dialogue_.receive(time)) {
    case LineDialogue::Result::kReply:
      return handleReply(dialogue_.reply());
    case LineDialogue::Result::kLate:
      return abort("no good reply in time");
    case LineDialogue::Result::kUnclear:
      return abort("more than one reply");
    case LineDialogue::Result::kNone:
      return;
  }
}

void SerialInjector::handleReply(const std::string& reply) {
  if (task_ != Task::kBegin && std::regex_match(reply, protocol_.refuse)) {
    unanswered_.reset();
    return abort("refused: " + reply, Refusal::kYes);
  }
  const InjectorProtocol::Exchange& exchange = exchanges(task_)[step_];
  std::smatch groups;
  std::string wrong = std::regex_match(reply, groups, exchange.expect) ? "" : "a wrong reply";
  // A device that was not told a pressure may have any.
  const bool is_new = task_ == Task::kQuery && !commanded_;
  if (wrong.empty() && (!is_new || exchange.confirm == kLine))
    wrong = InjectorProtocol::misread(exchange, groups, values_);
  const bool tells = exchange.confirm.empty() || (is_new && exchange.confirm == "pressure");
  if (wrong.empty() && task_ == Task::kQuery && groups.size() > 1 && tells) {
    const auto pressure = protocol_.queriedPressure(groups);
    if (pressure && limits_.checkPressure("", *pressure).empty()) {
      updatePressure(*pressure);
    } else {
      wrong = "a wrong reply";
    }
  }
  if (!wrong.empty()) {
    if (const auto lasts = InjectorProtocol::duration(exchange, groups); lasts && task_ == Task::kVerify) {
      unverified_->longest = std::max(unverified_->longest, ends_ - unverified_->pulse.duration + *lasts);
    }
    dialogue_.resynchronize(time_);
    return abort(wrong);
  }
  unanswered_.reset();
  if (++step_ == exchanges(task_).size()) complete();
}

void SerialInjector::complete() {
  const Task done = std::exchange(task_, Task::kNone);
  if (done == Task::kPulse || done == Task::kBalance || done == Task::kStop) pressureChanges();
  if (done == Task::kPulse) {
    const InjectionPulse pulse = protocol_.asSent(*sent_pulse_);
    protocol_.timed ? model_.open(pulse) : static_cast<void>(model_.pulse(pulse));
    ends_ = time_ + pulse.duration - protocol_.stop_latency;
    if (!protocol_.verify.empty()) unverified_ = Unverified{pulse, volume_, time_ + pulse.duration};
    sent_pulse_.reset();
  } else if (done == Task::kVerify) {
    ++done_;
    last_id_ = unverified_->pulse.id;
    unverified_.reset();
  } else if (done == Task::kBalance) {
    model_.setBalance(sent_balance_);
    balance_confirmed_ = true;
  } else if (done == Task::kStop) {
    stopped_ = true;
    if (model_.reading().busy) unverified_.reset();
    unconfirmed_until_ = time_;
    const bool late = over_ && tries_ > 0;
    over_ && !late ? model_.finish() : static_cast<void>(model_.stop());
    if (late) fail("the pulse lasted longer than requested: the device confirmed its end at the second attempt only");
    over_ = false;
  }
  tries_ = 0;
  if (done == Task::kQuery) query_tries_ = 0;
  if (query_tries_ < kTries) error_text_.clear();
}

/// Keeps the first reason, and adds others only once.
void SerialInjector::fail(const std::string& reason) {
  if (fault_.find(reason) == std::string::npos) fault_ += (fault_.empty() ? "" : "; ") + reason;
  if (waiting_pulse_) fault_ += "; pulse " + std::to_string(waiting_pulse_->id) + " was not sent";
  waiting_pulse_.reset();
}

/// Discards the queried pressure.
void SerialInjector::pressureChanges() {
  pressure_.reset();
  changed_ = time_;
}

/// A pressure queried before it has settled belongs to the time before or during the change.
void SerialInjector::updatePressure(double queried) {
  if (last_sent_ >= changed_ + settling_) pressure_ = queried;
}

void SerialInjector::report() {
  reading_ = model_.reading();
  if (std::exchange(seen_, reading_.pulses) != reading_.pulses) {
    waiting_verify_ = unverified_.has_value();
    if (!waiting_verify_ && reading_.last_id != given_up_) ++done_, last_id_ = reading_.last_id;
  }
  reading_.pulses = done_;
  reading_.last_id = last_id_;
  reading_.volume = volume_;
  reading_.busy = reading_.busy || waiting_pulse_ || sent_pulse_ || unverified_ || stopping();
  if (pressure_) reading_.pressure = *pressure_;
}

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
      repeatBalance();
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
