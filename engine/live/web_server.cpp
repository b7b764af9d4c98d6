#include "engine/live/web_server.h"

#include <fmt/format.h>
#include <sys/random.h>

#include <array>
#include <atomic>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <boost/beast/websocket.hpp>
#include <map>
#include <optional>
#include <thread>
#include <utility>

#include "engine/core/error.h"
#include "engine/live/foxglove_client.h"
#include "engine/live/request_check.h"

namespace vinerow::live {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = beast::http;
namespace websocket = beast::websocket;
using boost::system::error_code;
using std::chrono::milliseconds;
using std::chrono::seconds;
using tcp = asio::ip::tcp;

constexpr milliseconds kTick{50};
constexpr seconds kRequestTimeout{10};
constexpr std::size_t kMostClients = 100;
constexpr std::size_t kLongestMessage = 4 << 20;  // of a client

/// 128 random bits of the system as text.
std::string make_token() {
  std::array<unsigned char, 16> bytes{};
  if (::getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size())) {
    throw ConfigError("the system gives no random numbers for a token");
  }
  std::string token;
  for (const unsigned char byte : bytes) token += fmt::format("{:02x}", byte);
  return token;
}

using Request = http::request<http::string_body>;
using Response = http::response<http::string_body>;

/// State that connections share. Only the server's thread uses it, unless it says otherwise.
struct Shared {
  Shared(LiveRun& live, asio::io_context& context) : run(live), io(context) {}
  LiveRun& run;
  asio::io_context& io;
  std::string token;
  std::string session_id;
  std::function<std::vector<WebFile>()>
      make_page;            ///< empty: the run is being built, or it is called
  std::thread page_thread;  ///< runs make_page
  std::map<std::string, std::shared_ptr<const WebFile>> files;
  std::map<int, std::shared_ptr<class Connection>> clients;
  int next_client = 1;
  std::atomic<int> client_count = 0;  ///< from any thread
  bool is_closing = false;
};

/// Makes the page in a thread of its own, unless it is being made, or there is no run yet.
void make_page(Shared& shared) {
  if (!shared.make_page) return;
  shared.page_thread = std::thread([&shared, make = std::exchange(shared.make_page, nullptr)] {
    auto files = std::make_shared<std::vector<WebFile>>(make());
    asio::post(shared.io, [&shared, files] {
      for (WebFile& file : *files) {
        const std::string path = file.path;
        shared.files.emplace(path, std::make_shared<const WebFile>(std::move(file)));
      }
    });
  });
}

/// One client on a WebSocket.
class Connection final : public std::enable_shared_from_this<Connection> {
 public:
  Connection(Shared& shared, tcp::socket socket, int id)
      : shared_(shared), socket_(std::move(socket)), id_(id) {}

  void start(const Request& request, const std::string& protocol) {
    auto timeout = websocket::stream_base::timeout::suggested(beast::role_type::server);
    timeout.idle_timeout = seconds(60);
    timeout.keep_alive_pings = true;
    socket_.set_option(timeout);
    socket_.set_option(websocket::stream_base::decorator([protocol](auto& response) {
      response.set(http::field::server, "vinerow");
      response.set(http::field::sec_websocket_protocol, protocol);
    }));
    socket_.read_message_max(kLongestMessage);
    // Many small messages: do not wait to fill a packet.
    beast::get_lowest_layer(socket_).socket().set_option(tcp::no_delay(true));
    const std::weak_ptr<Connection> self = weak_from_this();
    asio::io_context& io = shared_.io;
    client_ = std::make_shared<FoxgloveClient>(shared_.run, fmt::format("client {}", id_),
                                               shared_.session_id, [self, &io] {
                                                 asio::post(io, [self] {
                                                   if (const auto connection = self.lock())
                                                     connection->write_next();
                                                 });
                                               });
    socket_.async_accept(request, [self = shared_from_this()](error_code error) {
      if (error) return self->drop();
      self->is_open_ = true;
      self->client_->greet();
      self->write_next();
      self->read_next();
    });
  }

  FoxgloveClient& client() { return *client_; }

  /// Sends what waits, then says goodbye.
  void close() {
    is_closing_ = true;
    write_next();
  }
  void drop() {
    if (std::exchange(is_dropped_, true)) return;
    client_->leave();
    error_code ignored;
    beast::get_lowest_layer(socket_).socket().close(ignored);
    shared_.clients.erase(id_);
    shared_.client_count = static_cast<int>(shared_.clients.size());
  }

 private:
  void read_next() {
    socket_.async_read(input_, [self = shared_from_this()](error_code error, std::size_t) {
      if (error) return self->drop();
      const auto bytes = self->input_.cdata();
      const auto* first = static_cast<const std::uint8_t*>(bytes.data());
      if (self->socket_.got_text()) {
        self->client_->on_text({reinterpret_cast<const char*>(first), bytes.size()});
      } else {
        self->client_->on_binary({first, bytes.size()});
      }
      self->input_.consume(self->input_.size());
      if (self->client_->outbox().is_flooded()) return self->drop();
      self->read_next();
    });
  }

  void write_next() {
    if (is_writing_ || !is_open_ || is_dropped_) return;
    frame_ = client_->outbox().take();
    if (!frame_) {
      if (is_closing_) say_goodbye();
      return;
    }
    is_writing_ = true;
    socket_.binary(frame_->is_binary);
    const asio::const_buffer body =
        frame_->body ? asio::buffer(*frame_->body) : asio::const_buffer();
    const std::array<asio::const_buffer, 2> buffers = {asio::buffer(frame_->head), body};
    socket_.async_write(buffers, [self = shared_from_this()](error_code error, std::size_t) {
      self->is_writing_ = false;
      if (error) return self->drop();
      self->write_next();
    });
  }

  void say_goodbye() {
    is_open_ = false;
    socket_.async_close(
        websocket::close_reason(websocket::close_code::going_away, "the run is over"),
        [self = shared_from_this()](error_code) { self->drop(); });
  }

  Shared& shared_;
  websocket::stream<beast::tcp_stream> socket_;
  const int id_;
  std::shared_ptr<FoxgloveClient> client_;
  beast::flat_buffer input_;
  std::optional<Frame> frame_;  ///< being sent
  bool is_open_ = false, is_writing_ = false, is_closing_ = false, is_dropped_ = false;
};

/// One HTTP connection, until it becomes a WebSocket.
class HttpConnection final : public std::enable_shared_from_this<HttpConnection> {
 public:
  HttpConnection(Shared& shared, tcp::socket socket)
      : shared_(shared), stream_(std::move(socket)) {}

  void read_next() {
    request_.emplace();
    request_->body_limit(kLongestRequestBody);
    stream_.expires_after(kRequestTimeout);
    http::async_read(stream_, input_, *request_,
                     [self = shared_from_this()](error_code error, std::size_t) {
                       if (!error) self->answer(self->request_->release());
                     });
  }

 private:
  static constexpr std::size_t kLongestRequestBody = 1 << 16;

  void answer(const Request& request) {
    const Target target = split_target({request.target().data(), request.target().size()});
    const auto field = [&](http::field name) {
      const auto value = request[name];
      return std::string(value.data(), value.size());
    };
    const bool has_token = !shared_.token.empty();
    if (has_token && !is_same_secret(target.token, shared_.token)) {
      return send(request, http::status::unauthorized,
                  "The token is missing or wrong: the run's terminal shows the whole address.\n");
    }
    if (websocket::is_upgrade(request)) {
      const std::string origin = field(http::field::origin);
      if (!has_token && !is_trusted_origin(origin)) {
        return send(
            request, http::status::forbidden,
            fmt::format("A page of {} may connect only with a token (--live-token).\n", origin));
      }
      const std::string protocol = choose_protocol(field(http::field::sec_websocket_protocol));
      if (protocol.empty()) {
        return send(request, http::status::bad_request,
                    fmt::format("The WebSocket must offer the subprotocol {} or {}.\n",
                                kFoxgloveProtocols[0], kFoxgloveProtocols[1]));
      }
      if (shared_.clients.size() >= kMostClients || shared_.is_closing) {
        return send(request, http::status::service_unavailable,
                    fmt::format("The run has {} clients already.\n", kMostClients));
      }
      return upgrade(request, protocol);
    }
    serve(request, target.path);
  }

  void upgrade(const Request& request, const std::string& protocol) {
    stream_.expires_never();
    const int id = shared_.next_client++;
    auto client = std::make_shared<Connection>(shared_, stream_.release_socket(), id);
    shared_.clients.emplace(id, client);
    shared_.client_count = static_cast<int>(shared_.clients.size());
    client->start(request, protocol);
  }

  void serve(const Request& request, const std::string& path) {
    if (request.method() != http::verb::get && request.method() != http::verb::head) {
      return send(request, http::status::method_not_allowed, "Only GET is possible.\n");
    }
    if (shared_.files.empty()) {
      make_page(shared_);
      // A browser asks again after a second.
      return send(request, http::status::service_unavailable,
                  "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\">"
                  "<meta http-equiv=\"refresh\" content=\"1\"><title>Vinerow live</title></head>"
                  "<body><p>The page is being made.</p></body></html>\n",
                  "text/html; charset=utf-8");
    }
    const auto file = shared_.files.find(path);
    if (file == shared_.files.end()) {
      return send(request, http::status::not_found, "There is no such file.\n");
    }
    send(request, http::status::ok, with_token(*file->second), file->second->media_type);
  }

  /// A page refers to its files as "live.js?{{token}}", because they need the token too.
  std::string with_token(const WebFile& file) const {
    if (!file.media_type.starts_with("text/html")) return file.bytes;
    std::string page = file.bytes;
    constexpr std::string_view kMark = "{{token}}";
    const std::string query =
        shared_.token.empty() ? "" : "token=" + percent_encoded(shared_.token);
    for (std::size_t at = 0; (at = page.find(kMark, at)) != std::string::npos;) {
      page.replace(at, kMark.size(), query);
      at += query.size();
    }
    return page;
  }

  void send(const Request& request, http::status status, const std::string& body,
            const std::string& media_type = "text/plain; charset=utf-8") {
    auto response = std::make_shared<Response>(status, request.version());
    response->set(http::field::server, "vinerow");
    response->set(http::field::content_type, media_type);
    response->set(http::field::cache_control, "no-store");
    response->set("X-Content-Type-Options", "nosniff");
    response->set("Content-Security-Policy",
                  "default-src 'self'; connect-src 'self' ws: wss:; img-src 'self' data: blob:; "
                  "style-src 'self' 'unsafe-inline'; frame-ancestors 'none'");
    response->keep_alive(request.keep_alive());
    response->body() = body;
    response->prepare_payload();
    if (request.method() == http::verb::head) response->body().clear();
    http::async_write(stream_, *response,
                      [self = shared_from_this(), response](error_code error, std::size_t) {
                        if (error || !response->keep_alive()) return self->close();
                        self->read_next();
                      });
  }

  void close() {
    error_code ignored;
    stream_.socket().shutdown(tcp::socket::shutdown_send, ignored);
  }

  Shared& shared_;
  beast::tcp_stream stream_;
  beast::flat_buffer input_{kLongestRequestBody};
  std::optional<http::request_parser<http::string_body>> request_;
};

}  // namespace

struct WebServer::Impl {
  Impl(LiveRun& run, const ServerOptions& options)
      : shared(run, io), acceptor(io), timer(io), host(options.host) {
    shared.token = options.token;
    shared.session_id = make_token().substr(0, 12);
    error_code error;
    const std::string address_text = options.host == "localhost" ? "127.0.0.1" : options.host;
    const asio::ip::address address = asio::ip::make_address(address_text, error);
    if (error) {
      throw ConfigError(fmt::format(
          "--live-host = '{}', must be an address of this machine: 127.0.0.1, or 0.0.0.0 for all",
          options.host));
    }
    is_local = address.is_loopback();
    if (!is_local && shared.token.empty()) shared.token = make_token();
    const tcp::endpoint endpoint(address, options.port);
    acceptor.open(endpoint.protocol(), error);
    if (!error) acceptor.set_option(tcp::acceptor::reuse_address(true), error);
    if (!error) acceptor.bind(endpoint, error);
    if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
    if (error == asio::error::address_in_use) {
      throw ConfigError(
          fmt::format("port {} is in use: another run, or another program; --live-port gives this "
                      "run another one, 0 any free one",
                      options.port));
    }
    if (error) {
      throw ConfigError(fmt::format("the live server cannot listen on {}:{}: {}", options.host,
                                    options.port, error.message()));
    }
    port = acceptor.local_endpoint().port();
  }

  void accept_next() {
    acceptor.async_accept([this](error_code error, tcp::socket socket) {
      if (error == asio::error::operation_aborted) return;
      if (!error) {
        std::make_shared<HttpConnection>(shared, std::move(socket))->read_next();
        return accept_next();
      }
      // Without descriptors, an immediate second try would fail and burn time.
      timer_accept.expires_after(milliseconds(100));
      timer_accept.async_wait([this](error_code stopped) {
        if (!stopped) accept_next();
      });
    });
  }

  void tick() {
    timer.expires_after(kTick);
    timer.async_wait([this](error_code error) {
      if (error) return;
      for_each_client([](FoxgloveClient& client) { client.tick(); });
      tick();
    });
  }

  template <class F>
  void for_each_client(const F& f) {
    const auto clients = shared.clients;  // a client may leave meanwhile
    for (const auto& [id, connection] : clients) f(connection->client());
  }

  asio::io_context io{1};
  Shared shared;
  tcp::acceptor acceptor;
  asio::steady_timer timer;
  asio::steady_timer timer_accept{io};
  std::string host;
  bool is_local = true;
  std::uint16_t port = 0;
  std::thread thread;
};

WebServer::WebServer(LiveRun& run, const ServerOptions& options)
    : impl_(std::make_unique<Impl>(run, options)) {
  impl_->accept_next();
  impl_->tick();
  impl_->thread = std::thread([impl = impl_.get()] { impl->io.run(); });
  run.add_listener(this);
}

WebServer::~WebServer() {
  Impl& impl = *impl_;
  impl.shared.run.remove_listener(this);
  asio::post(impl.io, [&impl] {
    impl.shared.is_closing = true;
    error_code ignored;
    impl.acceptor.close(ignored);
    impl.timer.cancel();
    impl.timer_accept.cancel();
    const auto clients = impl.shared.clients;
    for (const auto& [id, connection] : clients) connection->close();
  });
  constexpr auto kPatience = milliseconds(1000);
  const auto deadline = std::chrono::steady_clock::now() + kPatience;
  while (impl.shared.client_count > 0 && std::chrono::steady_clock::now() < deadline) {
    std::this_thread::sleep_for(milliseconds(5));
  }
  impl.io.stop();
  impl.thread.join();
  if (impl.shared.page_thread.joinable()) impl.shared.page_thread.join();
  // Connections refer to the shared state.
  for (const auto& [id, connection] : std::exchange(impl.shared.clients, {})) {
    connection->client().leave();
  }
}

std::uint16_t WebServer::port() const {
  return impl_->port;
}

std::string WebServer::url() const {
  const std::string host = impl_->is_local ? "localhost" : impl_->host;
  const std::string query = impl_->shared.token.empty()
                                ? ""
                                : fmt::format("?token={}", percent_encoded(impl_->shared.token));
  return fmt::format("http://{}:{}/{}", host, impl_->port, query);
}

int WebServer::clients() const {
  return impl_->shared.client_count;
}

void WebServer::set_page(std::function<std::vector<WebFile>()> make) {
  asio::post(impl_->io, [impl = impl_.get(), make = std::move(make)]() mutable {
    impl->shared.make_page = std::move(make);
  });
}

void WebServer::on_begin(Simulation&) {
  asio::post(impl_->io, [impl = impl_.get()] {
    impl->for_each_client([](FoxgloveClient& client) { client.greet(); });
  });
}

void WebServer::on_end() {
  on_status(RunControl::Level::kInfo, "the run is over");
}

void WebServer::on_status(RunControl::Level level, const std::string& sentence) {
  asio::post(impl_->io, [impl = impl_.get(), level, sentence] {
    impl->for_each_client([&](FoxgloveClient& client) { client.send_status(level, sentence); });
  });
}

}  // namespace vinerow::live
