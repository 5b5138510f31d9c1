/// A bake that cannot be shown; the message names the file and what to do.
export class BakeError extends Error {
    constructor(message) {
        super(message);
        this.name = "BakeError";
    }
}

/// Fetches a file of a bake. Errors: BakeError with its address and the server's answer.
export async function fetched(url) {
    let response;
    try {
        response = await fetch(url);
    } catch (error) {
        throw new BakeError(`${url}: ${error.message}; is the folder served over HTTP?`);
    }
    if (!response.ok) throw new BakeError(`${url}: ${response.status} ${response.statusText}`);
    return response;
}
