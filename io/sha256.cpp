// SPDX-License-Identifier: Apache-2.0
#include "io/sha256.h"

#include "emu/error.h"

#include <openssl/evp.h>

namespace tessemu {

struct Sha256::Impl {
    EVP_MD_CTX* context = EVP_MD_CTX_new();
    ~Impl() { EVP_MD_CTX_free(context); }
};

Sha256::Sha256() : impl_(std::make_unique<Impl>())
{
    if (EVP_DigestInit_ex(impl_->context, EVP_sha256(), nullptr) != 1)
        throw Error("SHA-256 is not available in this build of OpenSSL");
}

Sha256::~Sha256() = default;

void Sha256::add(void const* bytes, std::size_t count)
{
    EVP_DigestUpdate(impl_->context, bytes, count);
}

std::string Sha256::hex()
{
    unsigned char digest[EVP_MAX_MD_SIZE];
    unsigned size = 0;
    EVP_DigestFinal_ex(impl_->context, digest, &size);
    std::string out;
    for (unsigned i = 0; i < size; ++i) {
        out += "0123456789abcdef"[digest[i] >> 4];
        out += "0123456789abcdef"[digest[i] & 15];
    }
    return out;
}

std::string sha256_of(std::string const& text)
{
    Sha256 hash;
    hash.add(text.data(), text.size());
    return hash.hex();
}

} // namespace tessemu
