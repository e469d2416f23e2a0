#include "record/session_table.h"

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
    if (z <= kSurface) cell.touched_at = Eigen::Vector3d(0, 0, kSurface);
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

/// A recorder that looks every 10 ms.
std::string recordPromptly(const std::vector<Message>& messages) {
  SessionTable table(kPeriod, kPatience);
  table.advance(kStart);
  std::size_t next = 0;
  for (Nanoseconds now = kStart; now < kStart + kSteps * kMillisecond; now += 10 * kMillisecond) {
    for (; next < messages.size() && messages[next].stamp <= now; ++next) messages[next].put(table);
    table.advance(now);
  }
  table.finish();
  return table.text();
}

TEST(SessionTable, LayersStateAndVolumeStandAtTheEndOfARow) {
  SessionTable table(kPeriod, 0);
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
  const auto all = rows(table.text());
  ASSERT_EQ(all.size(), 2u);
  const std::vector<std::string> first(all[0].end() - 4, all[0].end()), last(all[1].end() - 4, all[1].end());
  EXPECT_EQ(first, (std::vector<std::string>{"0", "approach", "", "0"})) << "an unknown volume is an empty field";
  EXPECT_EQ(last, (std::vector<std::string>{"2", "inject", "2.5e-15", "2"}));
  EXPECT_NE(table.text().find(",layers_punctured,injection_state,injected_volume_m3,punctures_felt\n"),
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
  SessionTable table(kPeriod, kPatience);
  table.advance(kStart);
  std::size_t next = 0;
  for (Nanoseconds now = kStart; now < kStart + kSteps * kMillisecond; now += (300 + random() % 900) * kMillisecond) {
    for (; next < arrivals.size() && arrivals[next].first <= now; ++next) arrivals[next].second->put(table);
    table.advance(now);
  }
  for (; next < arrivals.size(); ++next) arrivals[next].second->put(table);
  table.advance(kStart + kSteps * kMillisecond - 10 * kMillisecond);
  table.finish();
  EXPECT_EQ(table.text(), recordPromptly(messages));
}

TEST(SessionTable, TheForceMeetsThePoseThatItBelongsTo) {
  SessionTable table(kPeriod, 0);
  table.cell.put(kStart, {{Eigen::Vector3d(0, 0, kSurface), false}});
  table.predicted.put(kStart, Eigen::Vector3d(0, 0, 1e-6));
  for (int i = 0; i <= 5; ++i) {  // the pose goes on while the force is late
    table.needle.put(kStart + i * kMillisecond, {{{0, 0, kSurface - 1e-6 * (i + 1)}, Eigen::Vector3d::UnitZ()}});
  }
  table.advance(kStart);
  table.advance(kStart + 5 * kMillisecond);
  for (const auto& row : rows(table.text())) EXPECT_NEAR(std::stod(row[2]), 1e-6, 1e-14);
}

TEST(SessionTable, WhatIsStaleOrTakenBackIsLeftEmpty) {
  SessionTable table(kPeriod, 0);
  table.needle.put(kStart, {{{0, 0, 30e-6}, Eigen::Vector3d::UnitZ()}});
  table.predicted.put(kStart, Eigen::Vector3d::Zero());
  table.measured.put(kStart, {{1e-6, 2e-6}});
  table.measured.withdraw();
  table.advance(kStart);
  table.advance(kStart + 60 * kMillisecond);
  const auto written = rows(table.text());
  ASSERT_EQ(written.size(), 13u);
  EXPECT_EQ(written[0][4], "1e-06");
  EXPECT_EQ(written[1][4], "");
  EXPECT_EQ(written[10][3], "0");
  EXPECT_EQ(written[11][3], "");
}

TEST(SessionTable, EndsWithTheOperator) {
  SessionTable table(kPeriod, 0);
  table.advance(kStart);
  table.phase.put(kStart + 2 * kMillisecond, "indent");
  table.phase.put(kStart + 12 * kMillisecond, "done");
  for (int i = 1; i < 10; ++i) table.advance(kStart + i * 10 * kMillisecond);
  table.finish();
  EXPECT_TRUE(table.done());
  EXPECT_EQ(rows(table.text()).size(), 3u);  // at 0, 5 and 10 ms
  EXPECT_NEAR(table.duration(), 0.010, 1e-12);
}

}  // namespace
}  // namespace microinjection
