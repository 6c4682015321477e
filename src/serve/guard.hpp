#pragma once
#include <string>

namespace ejecta {

/// Who may ask: only pages of this server, opened by whoever was told the token. Other programs on the
/// machine and pages of other sites in the same browser may not.
class Guard {
 public:
  explicit Guard(int port);

  const std::string& token() const { return token_; }
  std::string cookie_name() const;
  /// What a request says of itself; "" where it says nothing.
  struct Request {
    std::string host, origin, cookies, token;
  };
  /// Why it is refused, or "".
  std::string refusal(const Request& request) const;

 private:
  bool is_token(const std::string& given) const;
  int port_;
  std::string token_;
};

}  // namespace ejecta
