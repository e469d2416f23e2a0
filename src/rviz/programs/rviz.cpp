// rviz as its package has it, for a screen that is drawn in software.
//
// OGRE makes the window of the scene through one connection to the X server and draws through another one, which the
// server may serve first. Mesa's software driver ignores that the window is not there yet, takes its size from
// uninitialised memory and draws over the heap (swrastGetDrawableInfo in drisw_glx.c; Mesa 22.3). With synchronous
// connections the window is there before OGRE goes on.

#include <rviz/visualizer_app.h>

#include <QApplication>

/// Xlib's, see XSynchronize(3): other than 0, each connection that is opened from now on is synchronous.
extern "C" int _Xdebug;  // NOLINT(bugprone-reserved-identifier,readability-identifier-naming)

int main(int argc, char** argv) {
  _Xdebug = 1;
  QApplication application(argc, argv);
  rviz::VisualizerApp app;
  app.setApp(&application);
  return app.init(argc, argv) ? QApplication::exec() : 1;
}
