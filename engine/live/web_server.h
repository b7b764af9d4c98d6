#pragma once
/// Server beside a run: files by HTTP, and Foxglove's WebSocket protocol, on one port.
///
/// It has one thread, never waits for the run, and the run never waits for it.

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "engine/live/live_run.h"

namespace vinerow::live {

/// A file of the page.
struct WebFile {
  std::string path;  ///< "/live.js"; "/" is the page itself
  std::string media_type;
  /// In text/html, each "{{token}}" becomes "token=...", or nothing without a token.
  std::string bytes;
};

struct ServerOptions {
  std::string host = "127.0.0.1";  ///< address to listen on
  std::uint16_t port = 8765;       ///< 0 = any free one
  /// Clients must give it (?token=...). If it is empty and other machines can reach the address,
  /// the server makes one.
  std::string token;
};

class WebServer final : public RunListener {
 public:
  /// Listens from now on. @param run  outlives this object
  /// @throws ConfigError if the address is not valid or not of this machine, or the port is in use
  WebServer(LiveRun& run, const ServerOptions& options);
  /// Sends what waits for at most a second, and closes all connections.
  ~WebServer() override;

  std::uint16_t port() const;
  /// "http://localhost:8765/?token=..."
  std::string url() const;
  /// Connected clients.
  int clients() const;

  /// @param make  makes the files of the page when the first browser asks for one, in a thread of
  ///   its own while the run goes on; once. From any thread
  void set_page(std::function<std::vector<WebFile>()> make);

  void on_begin(Simulation& simulation) override;
  void on_end() override;
  void on_status(RunControl::Level level, const std::string& sentence) override;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace vinerow::live
