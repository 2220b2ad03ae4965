/* SPDX-License-Identifier: GPL-3.0-or-later */
#include "mail.h"

#include "../base/array.h"

#include <stdlib.h>
#include <string.h>

void tm_mail_free(tm_mail *mail)
{
    free(mail->count);
    free(mail->got_count);
    free(mail->place);
    *mail = (tm_mail){0};
}

tm_status tm_mail_address(tm_mail *mail, const unsigned *to, size_t items,
                          tm_error *error)
{
    const unsigned ranks = tm_ranks_count();
    *mail = (tm_mail){.items = items};
    mail->count = calloc(ranks, sizeof *mail->count);
    mail->got_count = calloc(ranks, sizeof *mail->got_count);
    mail->place = tm_new(items, sizeof *mail->place);
    size_t *next = calloc(ranks + (size_t)1, sizeof *next);
    tm_status status = TM_OK;
    if (!mail->count || !mail->got_count || !mail->place || !next)
        status = tm_fail_memory(error);
    for (size_t k = 0; k < items && status == TM_OK; k++)
        mail->count[to[k]]++;
    for (unsigned r = 0; r < ranks && status == TM_OK; r++)
        next[r + 1] = next[r] + mail->count[r];
    for (size_t k = 0; k < items && status == TM_OK; k++)
        mail->place[k] = next[to[k]]++;
    free(next);
    return tm_ranks_agree(status, error);
}

tm_status tm_mail_send(tm_mail *mail, const void *item, size_t size, void **got,
                       tm_error *error)
{
    char *sorted = tm_new(mail->items, size);
    *got = NULL;
    tm_status status = sorted ? TM_OK : tm_fail_memory(error);
    for (size_t k = 0; k < mail->items && sorted; k++)
        memcpy(sorted + size * mail->place[k], (const char *)item + size * k, size);
    status = tm_ranks_agree(status, error);
    if (status == TM_OK)
        status =
            tm_ranks_exchange(sorted, mail->count, size, got, mail->got_count, error);
    free(sorted);
    mail->got = 0;
    for (unsigned r = 0; r < tm_ranks_count() && status == TM_OK; r++)
        mail->got += mail->got_count[r];
    return status;
}

tm_status tm_mail_answer(const tm_mail *mail, const void *answer, size_t size, void **to,
                         tm_error *error)
{
    const unsigned ranks = tm_ranks_count();
    size_t *count = calloc(ranks, sizeof *count);
    char *own = tm_new(mail->items, size);
    void *sorted = NULL;
    tm_status status = tm_ranks_enough(count && own, error);
    if (status == TM_OK)
        status = tm_ranks_exchange(answer, mail->got_count, size, &sorted, count, error);
    for (size_t k = 0; k < mail->items && status == TM_OK && own; k++)
        memcpy(own + size * k, (const char *)sorted + size * mail->place[k], size);
    free(sorted);
    free(count);
    if (status != TM_OK) {
        free(own);
        own = NULL;
    }
    *to = own;
    return status;
}

unsigned tm_rank_of(const size_t *first, size_t item)
{
    unsigned begin = 0, end = tm_ranks_count();
    while (end - begin > 1) {
        const unsigned middle = begin + (end - begin) / 2;
        if (first[middle] <= item)
            begin = middle;
        else
            end = middle;
    }
    return begin;
}
