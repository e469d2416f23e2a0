#include "rviz/pixel_goal_bar.h"

#include <QGridLayout>

namespace microinjection {

PixelGoalBar::PixelGoalBar(QWidget* parent) : QWidget(parent), report_(new LampRow("", 1, this)) {
  auto* layout = new QGridLayout(this);
  layout->setContentsMargins(6, 0, 6, 2);
  layout->setHorizontalSpacing(8);
  layout->setVerticalSpacing(2);
  layout->setColumnStretch(1, 1);
  go_ = std::make_unique<OfferRow>("Go", 1, this, layout, 0, [this] {
    if (link_) link_->go();
  });
  cancel_ = std::make_unique<OfferRow>("Cancel", 1, this, layout, 1, [this] { cancel(); });
  layout->addWidget(report_, 0, 2, 2, 1);
  QSizePolicy stays = report_->sizePolicy();
  stays.setRetainSizeWhenHidden(true);
  report_->setSizePolicy(stays);
  layout->setColumnStretch(2, 1);
}

void PixelGoalBar::start(Bus& bus) {
  if (!link_) link_ = std::make_unique<PixelGoalLink>(bus);
}

void PixelGoalBar::cancel() {
  if (!link_) return;
  if (link_->goal().under_way) {
    link_->cancel();
  } else {
    link_->discard();
  }
}

void PixelGoalBar::propose(const Eigen::Vector2d& pixel) {
  if (link_) link_->propose(pixel);
}

void PixelGoalBar::discard() {
  if (link_) link_->discard();
}

std::optional<Eigen::Vector2d> PixelGoalBar::pixel() const { return link_ ? link_->goal().pixel : std::nullopt; }

void PixelGoalBar::refresh() {
  if (!link_) return;
  link_->poll();
  const CommandOffer offered = link_->offered();
  go_->display(offered.refusal.empty(), offered.refusal.empty() ? offered.effect : offered.refusal);
  const PixelGoal& goal = link_->goal();
  const bool cancels = goal.under_way || goal.pixel;
  cancel_->display(cancels, goal.under_way ? "stops the needle; STOP does so, too"
                            : goal.pixel   ? "forgets the place"
                                           : "");
  report_->setVisible(!link_->report().text.empty());
  report_->display(link_->report());
}

}  // namespace microinjection
