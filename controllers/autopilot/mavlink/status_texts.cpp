#include "controllers/autopilot/mavlink/status_texts.h"

#include <utility>

#include "controllers/autopilot/link/plain_text.h"

namespace vinerow::controllers {

std::vector<SpokenText> StatusTexts::take(const mavlink::StatusText& piece) {
  std::vector<SpokenText> whole;
  const bool continues = open_ && piece.id == id_ && piece.chunk_seq == next_piece_;
  if (open_ && !continues) whole.push_back(*std::exchange(open_, std::nullopt));
  const std::string text = plain_text(mavlink::text_of(piece.text));
  if (!open_) open_ = SpokenText{piece.severity, ""};
  open_->text += text;
  id_ = piece.id;
  next_piece_ = piece.chunk_seq + 1;
  // Id 0: the only piece. The last one of several is not full.
  const bool is_last = piece.id == 0 || text.size() < piece.text.size();
  if (is_last) whole.push_back(*std::exchange(open_, std::nullopt));
  return whole;
}

}  // namespace vinerow::controllers
