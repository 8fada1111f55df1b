"""What a diagnosis hands over: diagnosis.json and its schema, report.html, a summary in the terminal."""
