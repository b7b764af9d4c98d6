#include "tests/controllers/support/loop.h"

#include <algorithm>

namespace vinerow::test {

Loop::Loop(LoopSetup setup) : setup_(std::move(setup)), test_part_(full_part("test")) {
  if (setup_.physics.ns == 0) setup_.physics = setup_.tick;
  // Connected also if a test gives none.
  ports("test").write<PlannedPath>("plan");
  find("plan");
}

template <class Part>
Part& Loop::add(const std::string& role, Duration period, std::unique_ptr<Part> part) {
  Part& added = *part;
  Ports wires = ports(role);
  added.connect(wires);
  const SignalBase* event = find(role + "_event");
  members_.push_back({period.ns > 0 ? period : setup_.tick, std::move(part),
                      static_cast<const Signal<Event>*>(event)});
  return added;
}

Controller& Loop::add_controller(const PartChoice& choice, Duration period) {
  controller_ =
      &add("controller", period,
           parts().make_controller(choice.type, make_parameters(PartKind::kController, choice),
                                   make_context<ControllerContext>("controller", period)));
  return *controller_;
}

Guidance& Loop::add_guidance(const PartChoice& choice, Duration period) {
  guidance_ = &add("guidance", period,
                   parts().make_guidance(choice.type, make_parameters(PartKind::kGuidance, choice),
                                         make_context<ControllerContext>("guidance", period)));
  return *guidance_;
}

Estimator& Loop::add_estimator(const PartChoice& choice, Duration period) {
  has_estimator_ = true;
  return add("estimator", period,
             parts().make_estimator(choice.type, make_parameters(PartKind::kEstimator, choice),
                                    make_context<EstimatorContext>("estimator", period)));
}

void Loop::set_plant(Plant& plant) {
  set_plant([&plant] { return plant.truth(); },
            [this, &plant](double dt_s) { plant.step(actuators(), dt_s); });
}

void Loop::set_plant(std::function<Odometry()> truth, std::function<void(double)> move) {
  truth_ = std::move(truth);
  move_ = std::move(move);
}

void Loop::tick() {
  sense();
  decide();
  move();
}

void Loop::run_until(double time_s, const std::function<void()>& each) {
  const Time end{duration_from_s(time_s).ns};
  while (now_ < end) {
    sense();
    decide();
    if (each) each();
    move();
  }
}

void Loop::step() {
  decide();
  now_ = now_ + setup_.tick;
}

void Loop::step(const Odometry& estimate) {
  write("estimate", estimate);
  step();
}

void Loop::sense() {
  if (truth_) {
    Odometry sensed = truth_();
    if (change_estimate_) change_estimate_(sensed);
    write(has_estimator_ ? "truth" : "estimate", sensed);
  }
  if (stop_at_m_) give_authority(stop_at_m_(time_s()));
  if (inputs_) inputs_();
  if (truth_ && !is_checked_) bus_.check_connected();
  is_checked_ = true;
}

void Loop::decide() {
  for (Member& member : members_) {
    if (!is_due(member.period)) continue;
    member.part->step(now_);
    if (member.event == nullptr || member.event->sequence() == member.events_seen) continue;
    member.events_seen = member.event->sequence();
    events_.push_back({member.event->value(), now_});
  }
}

void Loop::move() {
  const std::int64_t steps = setup_.tick.ns / setup_.physics.ns;
  for (std::int64_t i = 0; move_ && i < steps; ++i) move_(setup_.physics.s());
  now_ = now_ + setup_.tick;
}

double Loop::value(std::string_view name, std::string_view entry) const {
  const NamedValues& all = read<NamedValues>(name);
  const auto at = std::find(all.names.begin(), all.names.end(), entry);
  if (at == all.names.end()) throw std::logic_error("no value " + std::string(entry));
  return all.values[static_cast<std::size_t>(at - all.names.begin())];
}

const SignalBase* Loop::find(std::string_view name) const {
  const auto found = signals_.find(name);
  if (found != signals_.end()) return found->second;
  const std::string local(name);
  SignalBase* signal = bus_.find(setup_.vehicle + "/" + local);
  if (signal != nullptr) signals_.emplace(local, signal);
  return signal;
}

std::vector<LoopEvent> Loop::events_with(std::string_view words) const {
  std::vector<LoopEvent> found;
  std::copy_if(events_.begin(), events_.end(), std::back_inserter(found),
               [&](const LoopEvent& e) { return e.text.find(words) != std::string::npos; });
  return found;
}

}  // namespace vinerow::test
