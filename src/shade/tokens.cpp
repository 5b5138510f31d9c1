#include "shade/tokens.h"

#include <algorithm>
#include <array>

namespace lobelia::shade {
namespace {

// What GLSL has and some of the languages lack, or write in another way.
constexpr std::array<std::string_view, 27> k_refused = {
    "while",   "do",    "switch", "case",    "goto",   "discard",  "in",    "out",   "inout",
    "uniform", "const", "mat2",   "mat3",    "mat4",   "uint",     "uvec2", "uvec3", "uvec4",
    "ivec2",   "ivec3", "ivec4",  "texture", "double", "saturate", "lerp",  "rsqrt", "select"};

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool is_digit(char c) { return c >= '0' && c <= '9'; }
bool is_blank(char c) { return c == ' ' || c == '\n'; }

class Splitter {
  public:
    explicit Splitter(std::string_view source) : source_(source) {}

    Result<std::vector<Token>> run() {
        while (at_ < source_.size()) {
            const std::size_t begin = at_;
            const Token::Kind kind = skip();
            std::string text(source_.substr(begin, at_ - begin));
            if (auto wrong = fault(kind, text); !wrong.empty()) return Error{place(begin) + std::move(wrong)};
            tokens_.push_back({kind, std::move(text)});
        }
        return std::move(tokens_);
    }

  private:
    template <class Test>
    void skip_while(const Test& test) {
        while (at_ < source_.size() && test(source_[at_])) ++at_;
    }
    [[nodiscard]] char next(std::size_t ahead = 0) const {
        return at_ + ahead < source_.size() ? source_[at_ + ahead] : '\0';
    }

    /// Moves past one token.
    Token::Kind skip() {
        const char c = next();
        if (is_blank(c)) return skip_while(is_blank), Token::Kind::blank;
        if (c == '/' && next(1) == '/') return skip_while([](char d) { return d != '\n'; }), Token::Kind::comment;
        if (is_letter(c)) {
            skip_while([](char d) { return is_letter(d) || is_digit(d); });
            return Token::Kind::word;
        }
        if (is_digit(c)) {
            skip_while([](char d) { return is_digit(d) || d == '.'; });
            if (next() == 'e') {
                at_ += next(1) == '-' || next(1) == '+' ? 2 : 1;
                skip_while(is_digit);
            }
            return Token::Kind::number;
        }
        constexpr std::array<std::string_view, 11> pairs = {
            "+=", "-=", "*=", "++", "<=", ">=", "==", "!=", "&&", "||", "/="};
        const auto pair = std::find(pairs.begin(), pairs.end(), source_.substr(at_, 2));
        at_ += pair != pairs.end() ? 2 : 1;
        return Token::Kind::sign;
    }

    /// Says what is wrong with a token, or nothing.
    [[nodiscard]] std::string fault(Token::Kind kind, std::string_view text) const {
        if (kind == Token::Kind::sign && text.find_first_not_of("+-*/<>=!&|.,;(){}[]") != std::string_view::npos)
            return "the character \"" + std::string(text) + "\" is not in the language";
        if (kind != Token::Kind::word) return {};
        const bool member = !tokens_.empty() && tokens_.back().is(".");
        constexpr std::string_view components = "xyzw";
        if (member && text.size() > 1 && text.find_first_not_of(components) == std::string_view::npos)
            return "\"." + std::string(text) + "\" has more than one component";
        const bool constant = text == "const" && (tokens_.empty() || tokens_.back().text.ends_with('\n'));
        if (!constant && std::find(k_refused.begin(), k_refused.end(), text) != k_refused.end())
            return "\"" + std::string(text) + "\" is not in the language";
        return {};
    }

    [[nodiscard]] std::string place(std::size_t offset) const {
        const auto line = 1 + std::count(source_.begin(), source_.begin() + static_cast<std::ptrdiff_t>(offset), '\n');
        return "shader code, line " + std::to_string(line) + ": ";
    }

    std::string_view source_;
    std::size_t at_ = 0;
    std::vector<Token> tokens_;
};

}  // namespace

Result<std::vector<Token>> tokens_of(std::string_view source) { return Splitter(source).run(); }

}  // namespace lobelia::shade
