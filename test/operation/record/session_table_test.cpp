#include "operation/record/session_table.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>
#include <sstream>
#include <vector>

namespace microinjection {
namespace {

constexpr Nanoseconds kMillisecond = 1000000;
constexpr Nanoseconds kPeriod = 5 * kMillisecond, kPatience = 2000 * kMillisecond;
constexpr double kSurface = 28e-6;  // m
constexpr double kStiffness = 0.2;  // N/m
constexpr double kSpeed = 10e-6;    // m/s
constexpr int kSteps = 3000;        // ms of session
const Nanoseconds kStart = 1800000000LL * 1000 * kMillisecond;

double height(int i) { return 38e-6 - kSpeed * 1e-3 * i; }  // touches after 1 s

/// A message: when its sender spoke, and what the table is to hear.
struct Message {
  int source;
  Nanoseconds stamp;
  std::function<void(SessionTable&)> put;
};

/// A needle that goes down through the surface of a spring; the cell's state comes at 60 Hz.
std::vector<Message> session() {
  std::vector<Message> messages;
  for (int i = 0; i < kSteps; ++i) {
    const Nanoseconds t = kStart + i * kMillisecond;
    const double z = height(i), force = std::max(0.0, kStiffness * (kSurface - z));
    messages.push_back({0, t, [=](SessionTable& table) {
                          table.needle.put(t, {{{0, 0, z}, Eigen::Vector3d::UnitZ()}});
                        }});
    messages.push_back({1, t, [=](SessionTable& table) { table.predicted.put(t, Eigen::Vector3d(0, 0, force)); }});
    messages.push_back({2, t, [=](SessionTable& table) { table.measured.put(t, {{force, 0}}); }});
    messages.push_back({3, t, [=](SessionTable& table) { table.hand_force.put(t, 2e5 * force); }});
    SessionTable::Cell cell;
    if (z <= kSurface) cell.contact_point = Eigen::Vector3d(0, 0, kSurface);
    if (i % 17 == 0) messages.push_back({4, t, [=](SessionTable& table) { table.cell.put(t, cell); }});
  }
  return messages;
}

std::vector<std::vector<std::string>> rows(const std::string& text) {
  std::vector<std::vector<std::string>> result;
  std::istringstream lines(text);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream fields(line);
    result.emplace_back();
    for (std::string field; std::getline(fields, field, ',');) result.back().push_back(field);
  }
  result.erase(result.begin());  // the header
  return result;
}

/// A table whose rows stay here.
struct Recorded {
  explicit Recorded(Nanoseconds patience)
      : table(kPeriod, patience, [this](const std::string& line) { text += line; }) {}
  std::string text = SessionTable::kHeader;
  SessionTable table;
};

/// A recorder that looks every 10 ms.
std::string recordPromptly(const std::vector<Message>& messages) {
  Recorded recorded(kPatience);
  SessionTable& table = recorded.table;
  table.advance(kStart);
  std::size_t next = 0;
  for (Nanoseconds now = kStart; now < kStart + kSteps * kMillisecond; now += 10 * kMillisecond) {
    for (; next < messages.size() && messages[next].stamp <= now; ++next) messages[next].put(table);
    table.advance(now);
  }
  table.finish();
  return recorded.text;
}

TEST(SessionTable, LayersStateAndVolumeStandAtTheEndOfARow) {
  Recorded recorded(0);
  SessionTable& table = recorded.table;
  SessionTable::Cell cell;
  std::vector<SessionTable::Row> told;
  table.onRow([&told](const SessionTable::Row& row) { told.push_back(row); });
  table.injection.put(kStart, {{"approach", 0}});
  table.cell.put(kStart, cell);
  table.advance(kStart);
  cell.layers_punctured = 2;
  table.cell.put(kStart + kPeriod, cell);
  table.injection.put(kStart + kPeriod, {{"inject", 2}});
  table.volume.put(kStart + kPeriod, 2.5e-15);
  table.advance(kStart + kPeriod);
  const auto all = rows(recorded.text);
  ASSERT_EQ(all.size(), 2u);
  const std::vector<std::string> first(all[0].end() - 4, all[0].end()), last(all[1].end() - 4, all[1].end());
  EXPECT_EQ(first, (std::vector<std::string>{"0", "approach", "", "0"})) << "an unknown volume is an empty field";
  EXPECT_EQ(last, (std::vector<std::string>{"2", "inject", "2.5e-15", "2"}));
  EXPECT_NE(recorded.text.find(",layers_punctured,injection_state,injected_volume_m3,punctures_felt\n"),
            std::string::npos);
  ASSERT_EQ(told.size(), 2u);
  EXPECT_EQ(told[0].volume, std::nullopt);
  EXPECT_EQ(told[1].volume, 2.5e-15);
  EXPECT_EQ(std::pair(told[1].injection, told[1].punctures), std::pair(std::string("inject"), 2));
}

TEST(SessionTable, DepthCountsFromWhereTheCellWasTouched) {
  const auto table = rows(recordPromptly(session()));
  ASSERT_GE(table.size(), 590u);
  for (const auto& row : table) {
    const double time = std::stod(row[0]), depth = kSpeed * time - 10e-6;
    if (std::abs(depth) < 1e-12) continue;
    EXPECT_EQ(row[2].empty(), depth < 0) << time;
    if (depth < 0) continue;
    EXPECT_NEAR(std::stod(row[2]), depth, 1e-14) << time;
    EXPECT_NEAR(std::stod(row[3]), kStiffness * depth, 1e-14) << time;
    EXPECT_EQ(row[7], "1");
  }
}

/// Messages that come in lumps of up to a second and a half, each source by itself: the same bytes.
TEST(SessionTable, ARecorderThatStarvesWritesTheSameRows) {
  const std::vector<Message> messages = session();
  std::vector<std::pair<Nanoseconds, const Message*>> arrivals;
  std::mt19937 random(7);
  std::vector<Nanoseconds> lump(5, kStart);
  for (std::size_t i = 0; i < messages.size(); ++i) {
    Nanoseconds& arrival = lump[messages[i].source];
    if (arrival < messages[i].stamp) arrival = messages[i].stamp + random() % (1500 * kMillisecond);
    arrivals.push_back({arrival, &messages[i]});
  }
  std::stable_sort(arrivals.begin(), arrivals.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  Recorded recorded(kPatience);
  SessionTable& table = recorded.table;
  table.advance(kStart);
  std::size_t next = 0;
  for (Nanoseconds now = kStart; now < kStart + kSteps * kMillisecond; now += (300 + random() % 900) * kMillisecond) {
    for (; next < arrivals.size() && arrivals[next].first <= now; ++next) arrivals[next].second->put(table);
    table.advance(now);
  }
  for (; next < arrivals.size(); ++next) arrivals[next].second->put(table);
  table.advance(kStart + kSteps * kMillisecond - 10 * kMillisecond);
  table.finish();
  EXPECT_EQ(recorded.text, recordPromptly(messages));
}

TEST(SessionTable, TheForceMeetsThePoseThatItBelongsTo) {
  Recorded recorded(0);
  SessionTable& table = recorded.table;
  table.cell.put(kStart, {{Eigen::Vector3d(0, 0, kSurface), false}});
  table.predicted.put(kStart, Eigen::Vector3d(0, 0, 1e-6));
  for (int i = 0; i <= 5; ++i) {  // the pose goes on while the force is late
    table.needle.put(kStart + i * kMillisecond, {{{0, 0, kSurface - 1e-6 * (i + 1)}, Eigen::Vector3d::UnitZ()}});
  }
  table.advance(kStart);
  table.advance(kStart + 5 * kMillisecond);
  for (const auto& row : rows(recorded.text)) EXPECT_NEAR(std::stod(row[2]), 1e-6, 1e-14);
}

TEST(SessionTable, WhatIsStaleOrTakenBackIsLeftEmpty) {
  Recorded recorded(0);
  SessionTable& table = recorded.table;
  table.needle.put(kStart, {{{0, 0, 30e-6}, Eigen::Vector3d::UnitZ()}});
  table.predicted.put(kStart, Eigen::Vector3d::Zero());
  table.measured.put(kStart, {{1e-6, 2e-6}});
  table.measured.withdraw();
  table.advance(kStart);
  table.advance(kStart + 60 * kMillisecond);
  const auto written = rows(recorded.text);
  ASSERT_EQ(written.size(), 13u);
  EXPECT_EQ(written[0][4], "1e-06");
  EXPECT_EQ(written[1][4], "");
  EXPECT_EQ(written[10][3], "0");
  EXPECT_EQ(written[11][3], "");
}

TEST(SessionTable, EndsWithTheOperator) {
  Recorded recorded(0);
  SessionTable& table = recorded.table;
  table.advance(kStart);
  table.phase.put(kStart + 2 * kMillisecond, "indent");
  table.phase.put(kStart + 12 * kMillisecond, "done");
  for (int i = 1; i < 10; ++i) table.advance(kStart + i * 10 * kMillisecond);
  table.finish();
  EXPECT_TRUE(table.done());
  EXPECT_EQ(rows(recorded.text).size(), 3u);  // at 0, 5 and 10 ms
  EXPECT_NEAR(table.duration(), 0.010, 1e-12);
}

TEST(SessionTable, ARowIsGivenAwayWhenItIsDue) {
  Recorded recorded(2 * kPeriod);
  recorded.table.advance(kStart);
  EXPECT_EQ(rows(recorded.text).size(), 0u);
  recorded.table.advance(kStart + 2 * kPeriod);
  EXPECT_EQ(rows(recorded.text).size(), 1u);
  recorded.table.advance(kStart + 10 * kPeriod);
  EXPECT_EQ(rows(recorded.text).size(), 9u);
}

/// A stamp that is ahead of the time by a second to a hundred years, in every column.
TEST(SessionTable, AWildStampCostsItsOwnMessage) {
  std::vector<Message> messages = session();
  const std::string clean = recordPromptly(messages);
  for (const Nanoseconds ahead : {1000 * kMillisecond, 3600 * 1000 * kMillisecond, Nanoseconds(3000000000000000000)}) {
    messages = session();
    for (int source = 0; source < 5; ++source) {
      const auto bad = std::find_if(messages.begin(), messages.end(), [source](const Message& message) {
        return message.source == source && message.stamp >= kStart + 500 * kMillisecond;
      });
      const Nanoseconds t = bad->stamp + ahead;
      bad->put = [source, t](SessionTable& table) {
        if (source == 0) table.needle.put(t, {{{0, 0, 1}, Eigen::Vector3d::UnitZ()}});
        if (source == 1) table.predicted.put(t, Eigen::Vector3d(0, 0, 9));
        if (source == 2) table.measured.put(t, {{9, 9}});
        if (source == 3) table.hand_force.put(t, 9.0);
        if (source == 4) table.cell.put(t, SessionTable::Cell{});
      };
    }
    const auto expected = rows(clean), written = rows(recordPromptly(messages));
    ASSERT_EQ(written.size(), expected.size());
    int different = 0;
    for (std::size_t i = 0; i < expected.size(); ++i) different += written[i] != expected[i];
    // The row that the message was for, and the one at its stamp, where the session lasts until then.
    EXPECT_LE(different, 2) << ahead;
    EXPECT_GE(different, 1) << ahead << ": the row that lacks its message";
  }
}

TEST(SessionTable, AfterTheEndNothingPilesUp) {
  Recorded recorded(0);
  SessionTable& table = recorded.table;
  table.phase.put(kStart, "done");
  for (int i = 0; i < 5000; ++i) {
    table.needle.put(kStart + i * kMillisecond, {{Eigen::Vector3d::Zero(), Eigen::Vector3d::UnitZ()}});
    table.advance(kStart + i * kMillisecond);
  }
  EXPECT_TRUE(table.done());
  EXPECT_LT(table.needle.size(), 200u);
}

/// A clock that leaps would ask for more rows than a disk can hold.
TEST(SessionTable, AClockThatLeapsHasNoRowsInBetween) {
  Recorded recorded(kPatience);
  SessionTable& table = recorded.table;
  for (int i = 0; i <= 1000; ++i) table.advance(kStart + i * 10 * kMillisecond);
  const Nanoseconds later = kStart + 100000000 * kMillisecond;
  for (int i = 0; i <= 1000; ++i) table.advance(later + i * 10 * kMillisecond);
  const auto ahead = rows(recorded.text);
  EXPECT_EQ(ahead.size(), 2001u + 2001u) << "the whole of the time before, and 10 s with those of the patience";
  EXPECT_NEAR(std::stod(ahead[2000][0]), 10, 1e-9);
  EXPECT_NEAR(std::stod(ahead[2001][0]), 1e5 - 2, 1e-3);
  for (int i = 0; i <= 1000; ++i) {
    const Nanoseconds now = kStart + (20000 + i * 10) * kMillisecond;
    table.volume.put(now, 1e-15);
    table.advance(now);
  }
  const auto back = rows(recorded.text);
  EXPECT_EQ(back.size(), ahead.size() + 2001u);
  EXPECT_NEAR(std::stod(back.back()[0]), 28, 1e-9);
  EXPECT_EQ(back.back()[14], "1e-15");
}

}  // namespace
}  // namespace microinjection
