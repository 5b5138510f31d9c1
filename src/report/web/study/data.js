// The study as its scripts use it.

export const study = JSON.parse(document.getElementById("study-data").textContent);

/// True for the names of references: curves and pictures to compare the others with.
export const is_reference = (name) => /^(numeric|reference|max\(0, cos\))/i.test(name);
