#include "shade/translate.h"

#include <algorithm>
#include <array>
#include <set>
#include <utility>
#include <vector>

#include "shade/tokens.h"

namespace lobelia::shade {
namespace {

using Kind = Token::Kind;
using Tokens = std::vector<Token>;
using Renames = std::span<const std::pair<std::string_view, std::string_view>>;

constexpr std::array k_types = {"float", "vec2", "vec3", "vec4", "int", "bool"};

constexpr std::array<std::pair<std::string_view, std::string_view>, 5> k_hlsl = {
    {{"vec2", "float2"}, {"vec3", "float3"}, {"vec4", "float4"}, {"mix", "lerp"}, {"inversesqrt", "rsqrt"}}};
constexpr std::array<std::pair<std::string_view, std::string_view>, 4> k_msl = {
    {{"vec2", "float2"}, {"vec3", "float3"}, {"vec4", "float4"}, {"inversesqrt", "rsqrt"}}};
constexpr std::array<std::pair<std::string_view, std::string_view>, 6> k_wgsl = {{{"vec2", "vec2f"},
                                                                                  {"vec3", "vec3f"},
                                                                                  {"vec4", "vec4f"},
                                                                                  {"float", "f32"},
                                                                                  {"int", "i32"},
                                                                                  {"inversesqrt", "inverseSqrt"}}};

Renames renames_of(Language language) {
    switch (language) {
        case Language::hlsl:
            return k_hlsl;
        case Language::msl:
            return k_msl;
        case Language::wgsl:
            return k_wgsl;
        default:
            return {};
    }
}

/// Walks over the tokens of a source and writes another language.
class Translator {
  public:
    Translator(Tokens tokens, Language language) : in_(std::move(tokens)), language_(language) {
        types_.insert(k_types.begin(), k_types.end());
        for (std::size_t i = 0; i + 2 < in_.size(); ++i)
            if (in_[i].is("struct")) types_.insert(in_[i + 2].text);
    }

    std::string run() {
        while (at_ < in_.size()) {
            if (!starts_statement(at_) || !declaration()) expression_token();
        }
        return std::move(out_);
    }

  private:
    // ---- Looking around ----

    /// The index of the next token that is neither blank nor comment, from `i` on.
    [[nodiscard]] std::size_t solid(std::size_t i) const {
        while (i < in_.size() && (in_[i].kind == Kind::blank || in_[i].kind == Kind::comment)) ++i;
        return i;
    }
    [[nodiscard]] const Token& token(std::size_t i) const {
        static const Token k_end;
        return i < in_.size() ? in_[i] : k_end;
    }
    /// Whether a statement may begin at token `i`: after { } ; or the ( of a "for", or at the beginning.
    [[nodiscard]] bool starts_statement(std::size_t i) const {
        if (in_[i].kind != Kind::word) return false;
        std::size_t before = i;
        while (before > 0) {
            const Token& t = in_[--before];
            if (t.kind == Kind::blank || t.kind == Kind::comment) continue;
            if (t.is("(")) return before > 1 && in_[before - 2].is("for");
            return t.is("{") || t.is("}") || t.is(";");
        }
        return true;
    }
    /// The index of the sign that closes the one at `open`.
    [[nodiscard]] std::size_t closing(std::size_t open) const {
        int depth = 0;
        for (std::size_t i = open; i < in_.size(); ++i) {
            if (in_[i].is("(") || in_[i].is("[") || in_[i].is("{")) ++depth;
            if (in_[i].is(")") || in_[i].is("]") || in_[i].is("}")) --depth;
            if (depth == 0) return i;
        }
        return in_.size();
    }
    /// The beginnings and ends of the arguments between two brackets.
    [[nodiscard]] std::vector<std::pair<std::size_t, std::size_t>> arguments(std::size_t open,
                                                                             std::size_t close) const {
        std::vector<std::pair<std::size_t, std::size_t>> list;
        std::size_t begin = open + 1;
        for (std::size_t i = open + 1; i <= close; ++i) {
            if (i == close || in_[i].is(",")) {
                list.emplace_back(solid(begin), i);
                begin = i + 1;
            } else if (in_[i].is("(") || in_[i].is("[")) {
                i = closing(i);
            }
        }
        return list;
    }

    // ---- Writing ----

    [[nodiscard]] std::string renamed(const std::string& word) const {
        for (const auto& [from, to] : renames_of(language_))
            if (word == from) return std::string(to);
        return word;
    }
    [[nodiscard]] std::string translated(std::size_t begin, std::size_t end) {
        std::string before = std::exchange(out_, {});
        const std::size_t place = std::exchange(at_, begin);
        copy_to(end);
        at_ = place;
        return std::exchange(out_, std::move(before));
    }
    void copy_to(std::size_t end) {
        while (at_ < end) expression_token();
    }

    /// Writes the token at hand; calls that differ between languages whole.
    void expression_token() {
        const Token& t = in_[at_];
        const std::size_t open = at_ + 1;
        const bool member = at_ > 0 && in_[at_ - 1].is(".");
        if (t.kind != Kind::word || member) {
            out_ += t.text;
            ++at_;
            return;
        }
        if (token(open).is("(")) {
            const std::size_t close = closing(open);
            const auto list = arguments(open, close);
            if (auto call = special_call(t.text, list); !call.empty()) {
                out_ += call;
                at_ = close + 1;
                return;
            }
        }
        out_ += renamed(t.text);
        ++at_;
    }
    /// A call that is more than a name and its arguments, or nothing.
    [[nodiscard]] std::string special_call(const std::string& name,
                                           const std::vector<std::pair<std::size_t, std::size_t>>& list) {
        const auto argument = [&](std::size_t i) { return translated(list[i].first, list[i].second); };
        if (name == "choose" && list.size() == 3) {
            if (language_ == Language::wgsl)
                return "select(" + argument(2) + ", " + argument(1) + ", " + argument(0) + ")";
            return "(" + argument(0) + " ? " + argument(1) + " : " + argument(2) + ")";
        }
        if (name == "atan" && list.size() == 2 && language_ != Language::glsl && language_ != Language::essl)
            return "atan2(" + argument(0) + ", " + argument(1) + ")";
        // HLSL has no constructor of a vector from one number, but a conversion.
        if (language_ == Language::hlsl && (name == "vec2" || name == "vec3" || name == "vec4") && list.size() == 1) {
            const bool simple = list[0].second == list[0].first + 1;
            return "(" + renamed(name) + ")" + (simple ? argument(0) : "(" + argument(0) + ")");
        }
        return {};
    }

    // ---- Declarations ----

    /// Writes what is declared at hand, if anything is.
    bool declaration() {
        const std::size_t word = at_;
        if (in_[word].is("struct")) return structure(word);
        if (in_[word].is("const")) return constant(word);
        if (!types_.contains(in_[word].text)) return false;
        const std::size_t name = solid(word + 1), after = solid(name + 1);
        if (token(name).kind != Kind::word) return false;
        if (token(after).is("(")) return function(word, name, after);
        return local(word, name, after);
    }

    bool structure(std::size_t word) {
        const std::size_t open = solid(solid(word + 1) + 1), close = closing(open);
        if (language_ != Language::wgsl) {
            copy_to(close + 1);
            return true;
        }
        copy_to(open + 1);
        while (at_ < close) {
            if (in_[at_].kind != Kind::word) {
                out_ += in_[at_++].text;
                continue;
            }
            const std::size_t name = solid(at_ + 1);
            std::string type = renamed(in_[at_].text);
            at_ = name + 1;
            if (token(at_).is("[")) {
                const std::size_t end = closing(at_);
                type = "array<" + type + ", " + translated(at_ + 1, end) + ">";
                at_ = end + 1;
            }
            out_ += in_[name].text + ": " + type + ",";
            ++at_;  // the semicolon
        }
        out_ += "}";
        at_ = token(close + 1).is(";") ? close + 2 : close + 1;
        return true;
    }

    bool constant(std::size_t word) {
        const std::size_t type = solid(word + 1), name = solid(type + 1);
        if (language_ == Language::wgsl) {
            out_ += "const " + in_[name].text + ": " + renamed(in_[type].text);
            at_ = name + 1;
        } else {
            out_ += language_ == Language::hlsl ? "static const " : language_ == Language::msl ? "constant " : "const ";
            out_ += renamed(in_[type].text) + " " + in_[name].text;
            at_ = name + 1;
        }
        return true;
    }

    bool function(std::size_t type, std::size_t name, std::size_t open) {
        const std::size_t close = closing(open), body = solid(close + 1);
        find_assigned(body, closing(body));
        if (language_ != Language::wgsl) return false;
        out_ += "fn " + in_[name].text + "(";
        bool first = true;
        for (const auto& [begin, end] : arguments(open, close)) {
            if (begin == end) continue;
            const std::size_t parameter = solid(begin + 1);
            out_ += (first ? "" : ", ") + in_[parameter].text + ": " + renamed(in_[begin].text);
            first = false;
        }
        out_ += ") -> " + renamed(in_[type].text);
        at_ = close + 1;
        return true;
    }

    bool local(std::size_t type, std::size_t name, std::size_t after) {
        if (language_ != Language::wgsl) return false;
        if (token(after).is(";")) {
            out_ += "var " + in_[name].text + ": " + renamed(in_[type].text);
        } else {
            out_ += (assigned_.contains(in_[name].text) ? "var " : "let ") + in_[name].text;
        }
        at_ = name + 1;
        return true;
    }

    /// Finds the names that statements between two tokens assign to after their declaration.
    void find_assigned(std::size_t begin, std::size_t end) {
        assigned_.clear();
        for (std::size_t i = begin; i < end; ++i) {
            if (in_[i].is("++") && i > 0) assigned_.insert(in_[i - 1].text);
            if (!starts_statement(i) || types_.contains(in_[i].text)) continue;
            // Skip members and indices of what is assigned to.
            std::size_t j = i + 1;
            while (j < end && (token(j).is(".") || token(j).is("["))) j = token(j).is("[") ? closing(j) + 1 : j + 2;
            j = solid(j);
            constexpr std::array<std::string_view, 5> signs = {"=", "+=", "-=", "*=", "/="};
            if (std::find(signs.begin(), signs.end(), token(j).text) != signs.end()) assigned_.insert(in_[i].text);
        }
    }

    Tokens in_;
    Language language_;
    std::size_t at_ = 0;
    std::string out_;
    std::set<std::string, std::less<>> types_, assigned_;
};

}  // namespace

Result<std::string> translate(std::string_view source, Language language) {
    auto tokens = tokens_of(source);
    if (!tokens) return tokens.error();
    return Translator(std::move(tokens).value(), language).run();
}

}  // namespace lobelia::shade
