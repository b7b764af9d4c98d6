#pragma once
/// Pictures of a session while a program steps it, as `vinerow render` draws them from a log.

#include <memory>
#include <string>

#include "engine/api/registry.h"
#include "engine/render/scene.h"
#include "engine/sim/session.h"

namespace vinerow::playback {

struct PictureChoice {
  std::string camera;  ///< of the scenario; empty: its first one, with the rays of range sensors
  int width = 640;
  int height = 360;
};

class SessionPictures {
 public:
  /// @throws ConfigError on a camera that the scenario does not have, or that shows the pictures of
  ///   a sensor
  SessionPictures(std::shared_ptr<const Registry> registry, PictureChoice choice);
  ~SessionPictures();
  SessionPictures(SessionPictures&&) noexcept;
  SessionPictures& operator=(SessionPictures&&) noexcept;

  /// Begins with a run of a session, or another one after its reset. The drawing of the world stays
  /// if it is the same world.
  /// @throws ConfigError on the camera; with the reason if this machine cannot draw
  void begin(const Session& session);
  /// Adds where the vehicles are, and their latest ranges. @pre begin() with the session's present
  /// run
  void note(const Session& session);
  /// The picture at the time of the last note(). @pre there was one
  render::Image draw() const;

 private:
  struct Run;
  std::shared_ptr<const Registry> registry_;
  PictureChoice choice_;
  std::shared_ptr<const WorldModel> world_;
  std::unique_ptr<render::Renderer> renderer_;
  std::unique_ptr<Run> run_;
};

}  // namespace vinerow::playback
