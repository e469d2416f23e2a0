#include "nodes/haptic/marker_server.h"

#include <utility>

#include "nodes/runtime/stamps.h"

namespace microinjection {
namespace {

constexpr double kKeepAlivePeriod = 0.5;  // s
constexpr double kClientTimeout = 1;      // s, without feedback of a client until another one may drag
constexpr std::uint32_t kMarkerQueue = 100;

}  // namespace

MarkerServer::MarkerServer(Bus& bus, const std::string& topic, const visualization_msgs::InteractiveMarker& marker,
                           Handler handler)
    : bus_(bus),
      marker_(marker),
      handler_(std::move(handler)),
      init_(bus.advertise<Init>(topic + "/update_full", kMarkerQueue, true)),
      update_(bus.advertise<Update>(topic + "/update", kMarkerQueue)),
      feedback_(bus.subscribe<Feedback>(topic + "/feedback", kMarkerQueue,
                                        [this](const Delivery<Feedback>& delivery) { receive(*delivery.message); })),
      keep_alive_(bus.timer(kKeepAlivePeriod, [this] { publish(Update()); })) {
  Update update;
  update.type = Update::UPDATE;
  update.markers = {marker_};
  publishChange(update, {marker_});
}

MarkerServer::~MarkerServer() {
  Update update;
  update.type = Update::UPDATE;
  update.erases = {marker_.name};
  publishChange(update, {});
}

void MarkerServer::receive(const Feedback& feedback) {
  if (feedback.marker_name != marker_.name) return;
  const ros::Time now = bus_.now();
  if (feedback.client_id != client_ && !isDue(client_heard_, now, kClientTimeout)) return;
  client_ = feedback.client_id;
  client_heard_ = now;
  if (feedback.event_type == Feedback::POSE_UPDATE) setPose(feedback.pose);
  handler_(feedback);
}

void MarkerServer::setPose(const geometry_msgs::Pose& pose) {
  marker_.pose = pose;
  moved_ = true;
}

void MarkerServer::applyChanges() {
  if (!moved_) return;
  moved_ = false;
  Update update;
  update.type = Update::UPDATE;
  update.poses.resize(1);
  update.poses[0].header = marker_.header;
  update.poses[0].pose = marker_.pose;
  update.poses[0].name = marker_.name;
  publishChange(update, {marker_});
}

void MarkerServer::publishChange(const Update& update, const std::vector<visualization_msgs::InteractiveMarker>& all) {
  ++changes_;
  publish(update);
  Init init;
  init.server_id = bus_.name();
  init.seq_num = changes_;
  init.markers = all;
  init_.publish(init);
}

void MarkerServer::publish(Update update) {
  update.server_id = bus_.name();
  update.seq_num = changes_;
  update_.publish(update);
}

}  // namespace microinjection
