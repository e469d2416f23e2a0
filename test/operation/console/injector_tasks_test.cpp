#include "operation/console/injector_tasks.h"

#include <gtest/gtest.h>

namespace microinjection {
namespace {

InjectorTasksView ready() {
  InjectorTasksView view;
  view.injector.emplace();
  view.listens = true;
  return view;
}

TEST(InjectorTasks, AreOfferedByAnInjectorThatListens) {
  for (const InjectorTask task : kInjectorTasks) {
    EXPECT_EQ(offer(task, ready()).refusal, "");
    EXPECT_EQ(offer(task, {}).refusal, "injector is silent");
  }
  InjectorTasksView deaf = ready();
  deaf.listens = false;
  EXPECT_EQ(offer(InjectorTask::kBalance, deaf).refusal, "injector does not receive commands yet");
  EXPECT_EQ(offer(InjectorTask::kReset, deaf).refusal, "");
}

TEST(InjectorTasks, NoResetDuringAPulseOrAnotherOne) {
  InjectorTasksView busy = ready(), called = ready();
  busy.injector->busy = called.called = true;
  EXPECT_EQ(offer(InjectorTask::kReset, busy).refusal, "no reset during a pulse");
  EXPECT_EQ(offer(InjectorTask::kReset, called).refusal, "the injector is asked");
  for (const InjectorTasksView& view : {busy, called}) EXPECT_EQ(offer(InjectorTask::kBalance, view).refusal, "");
}

TEST(InjectorTasks, TheTextHasTheReasonFirst) {
  EXPECT_EQ(injectorTasksText(ready()), "Reset clears fault and volume");
  InjectorTasksView view = ready();
  view.injector->busy = true;
  EXPECT_EQ(injectorTasksText(view), "no reset during a pulse");
  view.refusal = "/injector/reset does not answer";
  EXPECT_EQ(injectorTasksText(view), view.refusal);
}

}  // namespace
}  // namespace microinjection
